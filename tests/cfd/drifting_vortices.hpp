// Vortices that decay and drift in a periodic box of one cell's depth: smooth in space and time, to
// measure the order of a time scheme with.
#pragma once

#include <cmath>

#include "cfd/gas_solver.hpp"
#include "tests/cfd/gas_fixture.hpp"

namespace gasgrain::cfd::testing {

// Velocity after 0.2 s in `steps` equal steps; `choose(case)` sets viscosity and schemes.
template <class Choose>
VectorField drifting_vortices(int steps, const Choose& choose) {
  GasCase c = box_case(Vec3(1, 1, 1), {16, 1, 16});
  c.numerics.convection = Convection::central;
  c.numerics.pressure_tolerance = 1e-12;
  set_sides(c, 0, BoundaryType::periodic);
  set_sides(c, 1, BoundaryType::slip);
  set_sides(c, 2, BoundaryType::periodic);
  choose(c);
  GasSolver solver(c, MPI_COMM_SELF);
  const double k = 2.0 * M_PI;
  solver.set_velocity([k](const Vec3& x) {
    return Vec3(0.5 + std::sin(k * x[0]) * std::cos(k * x[2]), 0,
                0.2 - std::cos(k * x[0]) * std::sin(k * x[2]));
  });
  for (int n = 0; n < steps; ++n) solver.advance(0.2 / steps);
  return solver.velocity();
}

// 2-norm of the difference of the components in the plane, m/s.
inline double distance(const VectorField& a, const VectorField& b) {
  double sum = 0.0;
  for_each_cell(a[0].size(), [&](int i, int j, int k) {
    for (int d : {0, 2}) sum += std::pow(a[d](i, j, k) - b[d](i, j, k), 2);
  });
  return std::sqrt(sum);
}

}  // namespace gasgrain::cfd::testing
