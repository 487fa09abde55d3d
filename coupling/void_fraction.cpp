// Void fraction mapping D = S^n T and its transpose (design: coupling numerics).
//
//   T: quadratic B-spline on 27 cells, weights times (1 - alpha) and renormalized,
//        w_ic = b_ic (1 - alpha_c) / sum_c b_ic (1 - alpha_c)
//   S: aperture-weighted diffusion sweep (coupling/smoothing.cpp), n of them
//
// The weights of a grain add up to one over open cells, so the solid volume is conserved to
// round-off, always. The kernel is continuous in the grain's position, which keeps d(eps)/dt smooth
// when grains cross cells; centroid and satellite mappings do not. Those and others are there for
// comparison (coupling/mapping.hpp): ListedShares then takes the place of T, S and all else stay.
// Fields hold amounts per open volume, phi_c = q_c / ((1 - alpha_c) V). There T becomes
// b_ic / (V sum), and its transpose b_ic (1 - alpha_c) / sum acting on cell values: cheap, with one
// number per grain beside its nine spline weights.
// Assumes: a grain's cell belongs to this rank, so that the 27 cells lie within the ghosts.
// Source: Hockney & Eastwood, Computer Simulation Using Particles (1988), section 5-3 (TSC).
#include "coupling/void_fraction.hpp"

#include <cmath>

#include "cfd/loops.hpp"
#include "coupling/shared/error.hpp"

namespace gasgrain::coupling {

Deposition::Deposition(const cfd::Decomposition& decomposition, const cfd::WallGeometry& walls,
                       Mapping mapping)
    : decomposition_(decomposition), smoothing_(decomposition, walls) {
  if (mapping != Mapping::spline) listed_.emplace(decomposition, mapping);
}

void Deposition::set_walls(const cfd::WallGeometry& walls) {
  smoothing_.set_walls(walls);
  if (listed_) listed_->prepare(open_fraction(), largest_diameter_);
}

void Deposition::set_width(double width, double largest_diameter) {
  largest_diameter_ = largest_diameter;
  const cfd::Grid& grid = decomposition_.grid();
  smoothing_.set_plan(
      plan_smoothing(grid, width, mapping_variance(mapping(), grid, largest_diameter)));
  if (listed_) listed_->prepare(open_fraction(), largest_diameter);
}

void Deposition::locate(std::span<const Vec3> positions, std::span<const double> diameters) {
  if (listed_) return listed_->locate(positions, diameters);
  const cfd::Grid& grid = decomposition_.grid();
  const cfd::Block& block = decomposition_.block();
  const Vec3 per_cell = grid.spacing().cwiseInverse();
  const cfd::Field& open = open_fraction();
  stencils_.resize(positions.size());
  for (std::size_t n = 0; n < positions.size(); ++n) {
    const Vec3 scaled = (positions[n] - grid.lower).cwiseProduct(per_cell);
    const cfd::Index3 cell = grid.cell_of(positions[n]);
    cfd::Index3 local;
    Stencil& stencil = stencils_[n];
    for (int d = 0; d < 3; ++d) {
      local[d] = cell[d] - block.lower[d];
      GASGRAIN_ASSERT(local[d] >= 0 && local[d] < block.size[d]);
      stencil.spline[d] = spline_weights(scaled[d] - cell[d] - 0.5);
    }
    stencil.centre = open.index(local[0], local[1], local[2]);
    double sum = 0;
    for (int c = -1; c <= 1; ++c)
      for (int b = -1; b <= 1; ++b) {
        const double weight = stencil.spline[2][c + 1] * stencil.spline[1][b + 1];
        const double* row = open.data() + stencil.centre + c * open.stride(2) + b * open.stride(1);
        for (int a = -1; a <= 1; ++a) sum += weight * stencil.spline[0][a + 1] * row[a];
      }
    stencil.weight = sum > 1e-12 ? 1.0 / sum : 0.0;  // below: nothing but closed cells around it
  }
}

template <int components>
void Deposition::spread(CellArray<components>& density,
                        std::span<const std::array<double, components>> amounts) {
  GASGRAIN_ASSERT(amounts.size() == stencils_.size());
  const cfd::Field& open = open_fraction();
  const double per_volume = 1.0 / decomposition_.grid().cell_volume();
  const std::ptrdiff_t sy = open.stride(1), sz = open.stride(2);
  for (std::size_t n = 0; n < stencils_.size(); ++n) {
    const Stencil& stencil = stencils_[n];
    std::array<double, components> amount = amounts[n];
    for (double& value : amount) value *= stencil.weight * per_volume;
    for (int c = -1; c <= 1; ++c)
      for (int b = -1; b <= 1; ++b) {
        const double weight = stencil.spline[2][c + 1] * stencil.spline[1][b + 1];
        auto* row = density.data() + stencil.centre + c * sz + b * sy;
        for (int a = -1; a <= 1; ++a) {
          const double w = weight * stencil.spline[0][a + 1];
          for (int m = 0; m < components; ++m) row[a][m] += w * amount[m];
        }
      }
  }
  add_ghosts_to_owners<components>(decomposition_, density);
}

template <int components>
void Deposition::deposit(const std::array<cfd::Field*, components>& cells,
                         std::span<const std::array<double, components>> amounts) {
  const cfd::Field& open = open_fraction();
  CellArray<components>& density = std::get<CellArray<components>>(buffers_);
  density.assign(open.count(), {});
  if (listed_) {
    listed_->spread<components>(density, amounts);
  } else {
    spread<components>(density, amounts);
  }
  cfd::for_each_cell(open.size(), [&](int i, int j, int k) {
    const std::ptrdiff_t n = open.index(i, j, k);
    if (open[n] == 0.0) density[n].fill(0.0);
  });
  smoothing_.apply<components>(density);
  for (int m = 0; m < components; ++m) {
    cfd::Field& field = *cells[m];
    GASGRAIN_ASSERT(field.size() == open.size());
    cfd::for_each_cell(open.size(), [&](int i, int j, int k) {
      const std::ptrdiff_t n = open.index(i, j, k);
      field[n] = density[n][m];
    });
  }
}

template <int components>
void Deposition::gather(std::span<std::array<double, components>> values,
                        const std::array<const cfd::Field*, components>& cells) {
  const cfd::Field& open = open_fraction();
  CellArray<components>& weighted = std::get<CellArray<components>>(buffers_);
  weighted.assign(open.count(), {});
  cfd::for_each_cell(open.size(), [&](int i, int j, int k) {
    const std::ptrdiff_t n = open.index(i, j, k);
    if (open[n] == 0.0) return;
    for (int m = 0; m < components; ++m) weighted[n][m] = (*cells[m])[n];
  });
  smoothing_.apply<components>(weighted);
  cfd::for_each_cell(open.size(), [&](int i, int j, int k) {
    const std::ptrdiff_t n = open.index(i, j, k);
    for (double& value : weighted[n]) value *= open[n];
  });
  if (listed_) {
    listed_->collect<components>(values, weighted);
  } else {
    collect<components>(values, weighted);
  }
}

template <int components>
void Deposition::collect(std::span<std::array<double, components>> values,
                         CellArray<components>& weighted) {
  GASGRAIN_ASSERT(values.size() == stencils_.size());
  const cfd::Field& open = open_fraction();
  fill_ghosts<components>(decomposition_, weighted);
  const std::ptrdiff_t sy = open.stride(1), sz = open.stride(2);
  for (std::size_t n = 0; n < stencils_.size(); ++n) {
    const Stencil& stencil = stencils_[n];
    std::array<double, components> sum{};
    for (int c = -1; c <= 1; ++c)
      for (int b = -1; b <= 1; ++b) {
        const double weight = stencil.spline[2][c + 1] * stencil.spline[1][b + 1];
        const auto* row = weighted.data() + stencil.centre + c * sz + b * sy;
        for (int a = -1; a <= 1; ++a) {
          const double w = weight * stencil.spline[0][a + 1];
          for (int m = 0; m < components; ++m) sum[m] += w * row[a][m];
        }
      }
    for (int m = 0; m < components; ++m) values[n][m] = stencil.weight * sum[m];
  }
}

#define GASGRAIN_INSTANTIATE(components)                                                          \
  template void Deposition::deposit<components>(const std::array<cfd::Field*, components>&,       \
                                                std::span<const std::array<double, components>>); \
  template void Deposition::gather<components>(std::span<std::array<double, components>>,         \
                                               const std::array<const cfd::Field*, components>&);
GASGRAIN_INSTANTIATE(1)
GASGRAIN_INSTANTIATE(2)
GASGRAIN_INSTANTIATE(4)
GASGRAIN_INSTANTIATE(6)
#undef GASGRAIN_INSTANTIATE

}  // namespace gasgrain::coupling
