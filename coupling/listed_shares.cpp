// A grain's cells and shares are computed once per place and used by every deposit and gather at
// it. As with the B-spline a share counts times (1 - alpha) and is renormalized, so that closed
// cells take nothing and the volume is conserved. A grain whose mapping finds only closed cells
// (its centre beside a wall that has closed the cell) is spread by the B-spline over the open ones
// of 27 cells instead.
// Ghosts are as deep as the largest grain reaches and travel as in coupling/cell_array.cpp, so
// grains may be larger than a cell, but not reach beyond the neighbouring block.
#include "coupling/listed_shares.hpp"

#include <algorithm>
#include <limits>
#include <sstream>

#include "cfd/loops.hpp"
#include "coupling/shared/error.hpp"

namespace gasgrain::coupling {

namespace {

constexpr double least_open_sum = 1e-12;  // below: nothing but closed cells around the grain

// Fewest cells of a block in a direction in which ghosts are exchanged; equal on all ranks.
int thinnest_block(const cfd::Decomposition& decomposition) {
  int least = std::numeric_limits<int>::max();
  for (int d = 0; d < 3; ++d) {
    const int ranks = decomposition.ranks()[d];
    if (ranks > 1 || decomposition.periodic()[d])
      least = std::min(least, decomposition.grid().cells[d] / ranks);
  }
  return least;
}

// copy(to, from) between cfd::Field's layout (first index) and that of `ghosts`, owned cells.
template <class Copy>
void for_each_owned(const cfd::Index3& size, const GhostLayers& ghosts, Copy&& copy) {
  const CellStrides field(size, {}), own(size, ghosts);
  const int h = cfd::halo, g = ghosts.stored;
  cfd::for_each_cell(size, [&](int i, int j, int k) {
    copy((i + h) + (j + h) * field.y + (k + h) * field.z,
         (i + g) + (j + g) * own.y + (k + g) * own.z);
  });
}

}  // namespace

void ListedShares::prepare(const cfd::Field& open_fraction, double largest_diameter) {
  const int reach = mapping_reach(mapping_, decomposition_.grid(), largest_diameter);
  if (reach > thinnest_block(decomposition_)) {
    std::ostringstream message;
    message << "coupling.mapping = \"" << mapping_name(mapping_) << "\": a grain of "
            << largest_diameter << " m reaches over " << reach
            << " cells, more than a rank's block has in some direction; use fewer ranks, more "
               "cells in a periodic direction, or mapping = \"spline\"";
    throw UserError(message.str());
  }
  ghosts_ = {.stored = reach, .moved = reach};
  open_fraction_.assign(cell_array_size(decomposition_, ghosts_), {0.0});
  for_each_owned(open_fraction.size(), ghosts_, [&](std::ptrdiff_t field, std::ptrdiff_t own) {
    open_fraction_[own][0] = open_fraction[field];
  });
  fill_ghosts<1>(decomposition_, open_fraction_, ghosts_);
}

double ListedShares::list(Mapping mapping, const cfd::Index3& cell, const Vec3& offset,
                          const Vec3& radius) {
  const CellStrides stride(decomposition_.block().size, ghosts_);
  const int g = ghosts_.stored;
  share_among_cells(shares_, mapping, offset, radius);
  double sum = 0;
  for (const CellShare& share : shares_) {
    const std::ptrdiff_t n = (cell[0] + share.offset[0] + g) +
                             (cell[1] + share.offset[1] + g) * stride.y +
                             (cell[2] + share.offset[2] + g) * stride.z;
    entries_.push_back({n, share.share});
    sum += share.share * open_fraction_[n][0];
  }
  return sum;
}

void ListedShares::locate(std::span<const Vec3> positions, std::span<const double> diameters) {
  GASGRAIN_ASSERT(diameters.size() == positions.size());
  GASGRAIN_ASSERT(!open_fraction_.empty());
  const cfd::Grid& grid = decomposition_.grid();
  const cfd::Block& block = decomposition_.block();
  const Vec3 per_cell = grid.spacing().cwiseInverse();
  entries_.clear();
  begin_.assign(1, 0);
  weights_.resize(positions.size());
  for (std::size_t n = 0; n < positions.size(); ++n) {
    cfd::Index3 cell = grid.cell_of(positions[n]);
    Vec3 offset = (positions[n] - grid.lower).cwiseProduct(per_cell);
    for (int d = 0; d < 3; ++d) {
      offset[d] -= cell[d] + 0.5;
      cell[d] -= block.lower[d];
      GASGRAIN_ASSERT(cell[d] >= 0 && cell[d] < block.size[d]);
    }
    const Vec3 radius = 0.5 * diameters[n] * per_cell;
    GASGRAIN_ASSERT(mapping_reach(mapping_, grid, diameters[n]) <= ghosts_.moved);
    double sum = list(mapping_, cell, offset, radius);
    if (sum <= least_open_sum) {
      entries_.resize(begin_.back());
      sum = list(Mapping::spline, cell, offset, radius);
    }
    weights_[n] = sum > least_open_sum ? 1.0 / sum : 0.0;
    begin_.push_back(entries_.size());
  }
}

template <int components>
void ListedShares::spread(CellArray<components>& density,
                          std::span<const std::array<double, components>> amounts) const {
  const double per_volume = 1.0 / decomposition_.grid().cell_volume();
  CellArray<components> cells(open_fraction_.size());
  for (std::size_t n = 0; n < weights_.size(); ++n) {
    const double scale = weights_[n] * per_volume;
    for (std::size_t e = begin_[n]; e < begin_[n + 1]; ++e) {
      auto& cell = cells[entries_[e].cell];
      for (int m = 0; m < components; ++m) cell[m] += scale * entries_[e].share * amounts[n][m];
    }
  }
  add_ghosts_to_owners<components>(decomposition_, cells, ghosts_);
  for_each_owned(decomposition_.block().size, ghosts_,
                 [&](std::ptrdiff_t field, std::ptrdiff_t own) {
                   for (int m = 0; m < components; ++m) density[field][m] += cells[own][m];
                 });
}

template <int components>
void ListedShares::collect(std::span<std::array<double, components>> values,
                           const CellArray<components>& weighted) const {
  CellArray<components> cells(open_fraction_.size());
  for_each_owned(decomposition_.block().size, ghosts_,
                 [&](std::ptrdiff_t field, std::ptrdiff_t own) { cells[own] = weighted[field]; });
  fill_ghosts<components>(decomposition_, cells, ghosts_);
  for (std::size_t n = 0; n < weights_.size(); ++n) {
    std::array<double, components> sum{};
    for (std::size_t e = begin_[n]; e < begin_[n + 1]; ++e) {
      const auto& cell = cells[entries_[e].cell];
      for (int m = 0; m < components; ++m) sum[m] += entries_[e].share * cell[m];
    }
    for (int m = 0; m < components; ++m) values[n][m] = weights_[n] * sum[m];
  }
}

#define GASGRAIN_INSTANTIATE(components)                                                     \
  template void ListedShares::spread<components>(                                            \
      CellArray<components>&, std::span<const std::array<double, components>>) const;        \
  template void ListedShares::collect<components>(std::span<std::array<double, components>>, \
                                                  const CellArray<components>&) const;
GASGRAIN_FOR_COMPONENTS(GASGRAIN_INSTANTIATE)
#undef GASGRAIN_INSTANTIATE

}  // namespace gasgrain::coupling
