// Void fraction mapping D = S^n T and its transpose (design: coupling numerics).
//
//   T: quadratic B-spline on 27 cells, weights times (1 - alpha) and renormalized,
//        w_ic = b_ic (1 - alpha_c) / sum_c b_ic (1 - alpha_c)
//   S: aperture-weighted diffusion sweep (coupling/smoothing.cpp), n of them
//
// The weights of a grain add up to one over open cells, so the solid volume is conserved to
// round-off, always. The kernel is continuous in the grain's position, which keeps d(eps)/dt smooth
// when grains cross cells; centroid and satellite mappings do not. Those and others are there for
// comparison (coupling/mapping.hpp): ListedShares then takes the place of SplineShares as T, S and
// all else stay. Fields hold amounts per open volume, phi_c = q_c / ((1 - alpha_c) V). There T
// becomes b_ic / (V sum), and its transpose b_ic (1 - alpha_c) / sum acting on cell values: cheap,
// with one number per grain beside its place.
// Assumes: a grain's cell belongs to this rank, so that the 27 cells lie within the ghosts.
// Source: Hockney & Eastwood, Computer Simulation Using Particles (1988), section 5-3 (TSC).
#include "coupling/void_fraction.hpp"

#include <cmath>

#include "cfd/loops.hpp"
#include "coupling/shared/error.hpp"

namespace gasgrain::coupling {

Deposition::Deposition(const cfd::Decomposition& decomposition, const cfd::WallGeometry& walls,
                       Mapping mapping)
    : decomposition_(decomposition), smoothing_(decomposition, walls), spline_(decomposition) {
  if (mapping != Mapping::spline) {
    listed_.emplace(decomposition, mapping);
  } else {
    spline_.prepare(open_fraction());
  }
}

void Deposition::set_walls(const cfd::WallGeometry& walls) {
  smoothing_.set_walls(walls);
  if (listed_) {
    listed_->prepare(open_fraction(), largest_diameter_);
  } else {
    spline_.prepare(open_fraction());
  }
}

void Deposition::set_width(double width, double largest_diameter) {
  largest_diameter_ = largest_diameter;
  const cfd::Grid& grid = decomposition_.grid();
  smoothing_.set_plan(
      plan_smoothing(grid, width, mapping_variance(mapping(), grid, largest_diameter)));
  if (listed_) listed_->prepare(open_fraction(), largest_diameter);
}

void Deposition::locate(std::span<const Vec3> positions, std::span<const double> diameters) {
  if (listed_) {
    listed_->locate(positions, diameters);
    const cfd::Index3& size = decomposition_.block().size;
    range_ = {{{0, 0, 0}, size}, {{-1, -1, -1}, {size[0] + 1, size[1] + 1, size[2] + 1}}};
  } else {
    spline_.locate(positions);
    find_range();
  }
}

// The box around the grains of all ranks, wider by what a grain reaches: a cell by the spline and
// one by each sweep. All of a periodic direction across whose ends it reaches.
void Deposition::find_range() {
  const cfd::Index3& cells = decomposition_.grid().cells;
  const cfd::Block& block = decomposition_.block();
  const cfd::IndexBox& occupied = spline_.occupied();
  std::array<int, 6> ends;  // largest of: minus lower, upper; global indices
  for (int d = 0; d < 3; ++d) {
    ends[2 * d] = -(block.lower[d] + occupied.begin[d]);
    ends[2 * d + 1] = block.lower[d] + occupied.end[d];
  }
  MPI_Allreduce(MPI_IN_PLACE, ends.data(), 6, MPI_INT, MPI_MAX, decomposition_.communicator());
  const int reach = 1 + plan().sweeps;
  for (int d = 0; d < 3; ++d) {
    int begin = -ends[2 * d] - reach, end = ends[2 * d + 1] + reach;
    const bool beyond = begin < 1 || end > cells[d] - 1;  // with the ring
    if (decomposition_.periodic()[d] && beyond) begin = 0, end = cells[d];
    begin = std::max(begin, 0) - block.lower[d];
    end = std::min(end, cells[d]) - block.lower[d];
    range_.cells.begin[d] = std::max(begin, 0);
    range_.cells.end[d] = std::min(end, block.size[d]);
    range_.with_ring.begin[d] = std::max(begin, 0) - 1;
    range_.with_ring.end[d] = std::min(end, block.size[d]) + 1;
  }
}

template <int components>
CellArray<components>& Deposition::cleared_buffer() {
  CellArray<components>& buffer = std::get<CellArray<components>>(buffers_);
  buffer.resize(open_fraction().count());
  clear<components>(buffer, range_.with_ring, open_fraction());
  return buffer;
}

template <int components>
void Deposition::deposit(const std::array<cfd::Field*, components>& cells,
                         std::span<const std::array<double, components>> amounts) {
  const cfd::Field& open = open_fraction();
  CellArray<components>& density = cleared_buffer<components>();
  if (listed_) {
    listed_->spread<components>(density, amounts);
  } else {
    spline_.spread<components>(density, amounts);
    add_ghosts_to_owners<components>(decomposition_, density);
  }
  smoothing_.apply<components>(density, range_);
  std::array<double*, components> fields;
  for (int m = 0; m < components; ++m) {
    GASGRAIN_ASSERT(cells[m]->size() == open.size());
    cells[m]->fill(0.0);
    fields[m] = cells[m]->data();
  }
  cfd::for_each_row(range_.cells, open, [&](std::ptrdiff_t first, int length) {
    for (std::ptrdiff_t n = first; n < first + length; ++n) {
      const double is_open = open[n] > 0.0 ? 1.0 : 0.0;
      for (int m = 0; m < components; ++m) fields[m][n] = is_open * density[n][m];
    }
  });
}

template <int components>
void Deposition::gather(std::span<std::array<double, components>> values,
                        const std::array<const cfd::Field*, components>& cells) {
  const cfd::Field& open = open_fraction();
  CellArray<components>& weighted = cleared_buffer<components>();
  std::array<const double*, components> fields;
  for (int m = 0; m < components; ++m) fields[m] = cells[m]->data();
  cfd::for_each_row(range_.cells, open, [&](std::ptrdiff_t first, int length) {
    for (std::ptrdiff_t n = first; n < first + length; ++n) {
      if (open[n] == 0.0) continue;
      for (int m = 0; m < components; ++m) weighted[n][m] = fields[m][n];
    }
  });
  smoothing_.apply<components>(weighted, range_);
  cfd::for_each_row(range_.cells, open, [&](std::ptrdiff_t first, int length) {
    for (std::ptrdiff_t n = first; n < first + length; ++n) {
      for (double& value : weighted[n]) value *= open[n];
    }
  });
  if (listed_) {
    listed_->collect<components>(values, weighted);
  } else {
    fill_ghosts<components>(decomposition_, weighted);
    spline_.collect<components>(values, weighted);
  }
}

#define GASGRAIN_INSTANTIATE(components)                                                          \
  template void Deposition::deposit<components>(const std::array<cfd::Field*, components>&,       \
                                                std::span<const std::array<double, components>>); \
  template void Deposition::gather<components>(std::span<std::array<double, components>>,         \
                                               const std::array<const cfd::Field*, components>&);
GASGRAIN_FOR_COMPONENTS(GASGRAIN_INSTANTIATE)
#undef GASGRAIN_INSTANTIATE

}  // namespace gasgrain::coupling
