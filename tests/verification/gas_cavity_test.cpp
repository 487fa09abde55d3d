// The lid-driven cavity against published extremes.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/cfd/gas_fixture.hpp"

namespace gasgrain::cfd {
namespace {

using testing::box_case;
using testing::set_sides;

// Lid-driven cavity at Re 100, Ghia, Ghia & Shin (1982): extremes on the centre lines.
TEST(LidDrivenCavity, extremes_agree_with_ghia_at_re_100) {
  const int cells = 64;
  GasCase c = box_case(Vec3(1, 1.0 / cells, 1), {cells, 1, cells});
  c.gas.viscosity = 0.01;
  c.numerics.convection = Convection::central;
  c.numerics.pressure_tolerance = 1e-5;
  set_sides(c, 1, BoundaryType::slip);
  c.boundaries[2][1].wall_velocity = Vec3(1, 0, 0);
  GasSolver solver(c, MPI_COMM_WORLD);
  while (solver.time() < 12.0) solver.advance(solver.largest_stable_step());
  double u_min = 0.0, v_min = 0.0, v_max = 0.0;
  const Block& block = solver.decomposition().block();
  for_each_cell(block.size, [&](int i, int j, int k) {
    if (i + block.lower[0] == cells / 2) u_min = std::min(u_min, solver.velocity()[0](i, j, k));
    if (k + block.lower[2] == cells / 2) {
      v_min = std::min(v_min, solver.velocity()[2](i, j, k));
      v_max = std::max(v_max, solver.velocity()[2](i, j, k));
    }
  });
  const Decomposition& blocks = solver.decomposition();
  EXPECT_NEAR(-max_over_ranks(blocks, -u_min), -0.2109, 0.015 * 0.2109);
  EXPECT_NEAR(max_over_ranks(blocks, v_max), 0.1753, 0.025 * 0.1753);
  EXPECT_NEAR(-max_over_ranks(blocks, -v_min), -0.2453, 0.03 * 0.2453);
}

}  // namespace
}  // namespace gasgrain::cfd
