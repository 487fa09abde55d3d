// Flood fill: every rank finds its own connected components by breadth-first search and names them
// by the smallest global cell number; then names travel through the ghost layer and the smaller one
// wins until nothing changes. The number of exchanges is the number of blocks a region winds
// through.
#include "cfd/gas_regions.hpp"

#include <algorithm>
#include <cmath>

#include "cfd/halo_exchange.hpp"
#include "cfd/loops.hpp"

namespace gasgrain::cfd {

namespace {

constexpr double no_name = -1.0;

class FloodFill {
 public:
  FloodFill(const Decomposition& decomposition, const VectorField& joined, const Field& outlet)
      : decomposition_(decomposition),
        joined_(joined),
        outlet_(outlet),
        size_(decomposition.block().size),
        name_(size_, no_name) {
    find_local_components();
    while (exchange_names()) {
    }
  }

  GasRegions regions() const;

 private:
  std::ptrdiff_t cell_number(int i, int j, int k) const {
    return i + std::ptrdiff_t(size_[0]) * (j + std::ptrdiff_t(size_[1]) * k);
  }
  double global_number(int i, int j, int k) const {
    const Index3& lower = decomposition_.block().lower;
    const Index3& cells = decomposition_.grid().cells;
    return (i + lower[0]) + double(cells[0]) * ((j + lower[1]) + double(cells[1]) * (k + lower[2]));
  }
  Index3 cell_of_number(double number) const {
    const Index3& cells = decomposition_.grid().cells;
    const auto n = static_cast<long long>(number);
    return {int(n % cells[0]), int(n / cells[0] % cells[1]), int(n / cells[0] / cells[1])};
  }

  // visit(neighbour cell) across each joined face of the cell.
  template <class Visit>
  void for_each_joined(const Index3& cell, Visit&& visit) const {
    for (int d = 0; d < 3; ++d) {
      Index3 above = cell, below = cell;
      ++above[d];
      --below[d];
      if (joined_[d](cell[0], cell[1], cell[2]) > 0) visit(below);
      if (joined_[d](above[0], above[1], above[2]) > 0) visit(above);
    }
  }
  bool owned(const Index3& cell) const {
    for (int d = 0; d < 3; ++d) {
      if (cell[d] < 0 || cell[d] >= size_[d]) return false;
    }
    return true;
  }
  bool in_gas(const Index3& cell) const {
    bool any = outlet_(cell[0], cell[1], cell[2]) > 0;
    for_each_joined(cell, [&](const Index3&) { any = true; });
    return any;
  }

  void find_local_components();
  void gather_component(const Index3& seed, int component);
  bool exchange_names();

  const Decomposition& decomposition_;
  const VectorField& joined_;
  const Field& outlet_;
  Index3 size_;
  Field name_;                                    // smallest global cell number known
  std::vector<int> component_;                    // of owned cells
  std::vector<double> component_name_;            // per component
  std::vector<std::vector<Index3>> at_the_edge_;  // per component: cells joined to ghosts
};

void FloodFill::find_local_components() {
  component_.assign(cell_number(0, 0, size_[2]), GasRegions::none);
  for_each_cell(size_, [&](int i, int j, int k) {
    if (component_[cell_number(i, j, k)] != GasRegions::none || !in_gas({i, j, k})) return;
    component_name_.push_back(global_number(i, j, k));
    at_the_edge_.emplace_back();
    gather_component({i, j, k}, static_cast<int>(component_name_.size()) - 1);
  });
}

void FloodFill::gather_component(const Index3& seed, int component) {
  std::vector<Index3> queue{seed};
  component_[cell_number(seed[0], seed[1], seed[2])] = component;
  while (!queue.empty()) {
    const Index3 cell = queue.back();
    queue.pop_back();
    bool edge = false;
    for_each_joined(cell, [&](const Index3& next) {
      if (!owned(next)) {
        edge = true;
      } else if (int& mark = component_[cell_number(next[0], next[1], next[2])];
                 mark == GasRegions::none) {
        mark = component;
        queue.push_back(next);
      }
    });
    if (edge) at_the_edge_[component].push_back(cell);
  }
}

bool FloodFill::exchange_names() {
  for_each_cell(size_, [&](int i, int j, int k) {
    const int component = component_[cell_number(i, j, k)];
    if (component != GasRegions::none) name_(i, j, k) = component_name_[component];
  });
  fill_ghosts(decomposition_, name_);
  bool changed = false;
  for (std::size_t c = 0; c < component_name_.size(); ++c) {
    for (const Index3& cell : at_the_edge_[c]) {
      for_each_joined(cell, [&](const Index3& next) {
        const double other = name_(next[0], next[1], next[2]);
        if (owned(next) || other == no_name || other >= component_name_[c]) return;
        component_name_[c] = other;
        changed = true;
      });
    }
  }
  return max_over_ranks(decomposition_, changed ? 1.0 : 0.0) > 0.0;
}

// All names that occur on any rank, ascending.
std::vector<double> gather_names(const Decomposition& decomposition, std::vector<double> names) {
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  const int count = static_cast<int>(names.size());
  std::vector<int> counts(decomposition.size()), offsets(decomposition.size() + 1, 0);
  MPI_Allgather(&count, 1, MPI_INT, counts.data(), 1, MPI_INT, decomposition.communicator());
  for (int r = 0; r < decomposition.size(); ++r) offsets[r + 1] = offsets[r] + counts[r];
  std::vector<double> all(offsets.back());
  MPI_Allgatherv(names.data(), count, MPI_DOUBLE, all.data(), counts.data(), offsets.data(),
                 MPI_DOUBLE, decomposition.communicator());
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

GasRegions FloodFill::regions() const {
  const std::vector<double> names = gather_names(decomposition_, component_name_);
  GasRegions result;
  result.region_of_cell.assign(component_.size(), GasRegions::none);
  std::vector<double> cells(names.size(), 0.0), outlets(names.size(), 0.0);
  for_each_cell(size_, [&](int i, int j, int k) {
    const int component = component_[cell_number(i, j, k)];
    if (component == GasRegions::none) return;
    const auto found = std::lower_bound(names.begin(), names.end(), component_name_[component]);
    const auto region = found - names.begin();
    result.region_of_cell[cell_number(i, j, k)] = static_cast<int>(region);
    cells[region] += 1.0;
    if (outlet_(i, j, k) > 0) outlets[region] += 1.0;
  });
  sum_over_ranks(decomposition_, cells);
  sum_over_ranks(decomposition_, outlets);
  for (std::size_t r = 0; r < names.size(); ++r) {
    result.regions.push_back({outlets[r] > 0, cells[r], cell_of_number(names[r])});
  }
  return result;
}

}  // namespace

bool GasRegions::any_singular() const {
  return std::any_of(regions.begin(), regions.end(),
                     [](const GasRegion& region) { return !region.has_outlet; });
}

GasRegions find_gas_regions(const Decomposition& decomposition, const VectorField& joined,
                            const Field& outlet) {
  return FloodFill(decomposition, joined, outlet).regions();
}

void sum_per_region(std::vector<double>& sums, const Decomposition& decomposition,
                    const GasRegions& regions, const Field& values) {
  sums.assign(regions.regions.size(), 0.0);
  std::size_t n = 0;
  for_each_cell(values.size(), [&](int i, int j, int k) {
    const int region = regions.region_of_cell[n++];
    if (region != GasRegions::none) sums[region] += values(i, j, k);
  });
  sum_over_ranks(decomposition, sums);
}

std::vector<double> sum_per_region(const Decomposition& decomposition, const GasRegions& regions,
                                   const Field& values) {
  std::vector<double> sums;
  sum_per_region(sums, decomposition, regions, values);
  return sums;
}

void subtract_per_region(Field& values, const GasRegions& regions,
                         const std::vector<double>& amounts) {
  std::size_t n = 0;
  for_each_cell(values.size(), [&](int i, int j, int k) {
    const int region = regions.region_of_cell[n++];
    if (region != GasRegions::none) values(i, j, k) -= amounts[region];
  });
}

void means_of_singular_regions(std::vector<double>& means, const Decomposition& decomposition,
                               const GasRegions& regions, const Field& values) {
  sum_per_region(means, decomposition, regions, values);
  for (std::size_t r = 0; r < means.size(); ++r) {
    const GasRegion& region = regions.regions[r];
    means[r] = region.has_outlet ? 0.0 : means[r] / region.cells;
  }
}

}  // namespace gasgrain::cfd
