#include "cfd/fixed_bed.hpp"

#include <algorithm>

#include "cfd/loops.hpp"
#include "coupling/shared/error.hpp"

namespace gasgrain::cfd {

namespace {

// Share of a cell [lower, lower + h] inside the box of the bed.
double covered_share(const FixedBed& bed, const Vec3& lower, const Vec3& h) {
  double share = 1.0;
  for (int d = 0; d < 3; ++d) {
    const double from = std::max(lower[d], bed.lower[d]);
    const double to = std::min(lower[d] + h[d], bed.upper[d]);
    share *= std::clamp((to - from) / h[d], 0.0, 1.0);
  }
  return share;
}

}  // namespace

FixedBedDrag::FixedBedDrag(GasSolver& solver)
    : closure_(find_drag_closure(solver.gas_case().fixed_bed.drag)),
      solid_(solver.decomposition().block().size) {
  const FixedBed& bed = solver.gas_case().fixed_bed;
  const Grid& grid = solver.decomposition().grid();
  const Block& block = solver.decomposition().block();
  const Vec3 h = grid.spacing();
  GASGRAIN_ASSERT(closure_ != nullptr);
  for_each_cell(block.size, [&](int i, int j, int k) {
    const Vec3 steps(i + block.lower[0], j + block.lower[1], k + block.lower[2]);
    const double share = covered_share(bed, grid.lower + steps.cwiseProduct(h), h);
    solid_(i, j, k) = share * (1.0 - bed.void_fraction);
    solver.grains().void_fraction(i, j, k) = 1.0 - solid_(i, j, k);
  });
  solver.accept_void_fraction_as_old();
}

void FixedBedDrag::update(GasSolver& solver) const {
  const GasCase& gas_case = solver.gas_case();
  DragInput input{.void_fraction = gas_case.fixed_bed.void_fraction,
                  .diameter = gas_case.fixed_bed.diameter,
                  .slip = 0.0,
                  .density = gas_case.gas.density,
                  .viscosity = gas_case.gas.viscosity};
  VectorField velocity, gradient;
  solver.sample_at_cells(velocity, gradient);
  for_each_cell(solid_.size(), [&](int i, int j, int k) {
    const std::ptrdiff_t n = solid_.index(i, j, k);
    input.slip = Vec3(velocity[0][n], velocity[1][n], velocity[2][n]).norm();
    solver.grains().momentum_exchange[n] = solid_[n] > 0.0 ? solid_[n] * closure_(input) : 0.0;
  });
}

}  // namespace gasgrain::cfd
