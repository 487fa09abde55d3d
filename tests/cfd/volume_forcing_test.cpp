// Bodies imposed by volume fractions: the momentum budget still closes and what it cannot do is
// refused. Its errors are measured in tests/verification.
#include "cfd/volume_forcing.hpp"

#include <gtest/gtest.h>

#include <string>

#include "tests/cfd/gas_fixture.hpp"
#include "tests/shared/error_checks.hpp"

namespace gasgrain::cfd {
namespace {

using testing::bodies;
using testing::box_case;
using testing::set_moving_heap;
using testing::set_sides;
using testing::side;

const std::string ball = "[[body]]\nname='ball'\nsphere={center=[0.45,0.5,0.9],radius=0.3}\n";

// Gas that rises past a ball that never stands on a grid line.
GasCase column(const std::string& text = ball) {
  GasCase c = box_case(Vec3(1, 1, 2), {8, 8, 16});
  c.gas = {.density = 1.2, .viscosity = 0.02, .gravity = Vec3(0, 0, -9.81)};
  c.numerics.immersed_boundary = BodyMethod::volume_forcing;
  set_sides(c, 0, BoundaryType::slip);
  c.boundaries[2][0] = testing::inlet(Vec3(0, 0, 0.5));
  c.boundaries[2][1] = side(BoundaryType::outlet);
  c.bodies = bodies(text);
  return c;
}

std::string refusal_of(const GasCase& c) {
  return user_error([&] { GasSolver(c, MPI_COMM_WORLD); });
}

class VolumeForcingOf : public ::testing::TestWithParam<TimeScheme> {};
INSTANTIATE_TEST_SUITE_P(Schemes, VolumeForcingOf,
                         ::testing::Values(TimeScheme::ab2, TimeScheme::rk2));

TEST_P(VolumeForcingOf, closes_the_momentum_budget_and_the_loads) {
  GasCase gas_case = column();
  gas_case.numerics.time_scheme = GetParam();
  GasSolver solver(gas_case, MPI_COMM_WORLD);
  set_moving_heap(solver, 0.0, 0.3, 40.0);
  solver.accept_void_fraction_as_old();
  for (int n = 1; n <= 3; ++n) {
    const double dt = 1e-3 * n;
    set_moving_heap(solver, 0.05 * n, 0.3, 40.0);
    const StepReport report = solver.advance(dt);
    const MomentumBudget& m = report.momentum;
    const double scale = testing::turnover(m);
    EXPECT_GT(m.body.norm(), 1e-3 * scale);
    EXPECT_LT(testing::imbalance(m).norm(), 1e-12 * scale);
    EXPECT_LT(testing::pressure_imbalance(m).norm(), 1e-12 * scale);
    const BodyLoad& load = solver.body_loads().at(0);
    EXPECT_LT((dt * load.pressure + m.body_pressure).norm(), 1e-12 * scale);
    EXPECT_LT((dt * load.friction + m.body + m.body_stress).norm(), 1e-12 * scale);
    EXPECT_LT(report.divergence, 1e-8);
  }
}

// A plate of four cells across the whole column, along grid lines. All gas goes through it: on its
// three inner faces each step has to bring u* = 0 to U against gamma rho, on the two outer ones,
// half solid, U/2 to U against (gamma + 1)/2 rho.
TEST(VolumeForcing, makes_gas_inside_a_body_as_heavy_as_the_density_scaling_says) {
  const double speed = 0.5, dt = 1e-3, height = 0.125;
  for (const double gamma : {1.0, 30.0, 1000.0}) {
    GasCase c = column("[[body]]\nname='plate'\nbox={lower=[-1,-1,0.75],upper=[2,2,1.25]}\n");
    c.gas = {.density = 1.2, .viscosity = 0.0, .gravity = Vec3::Zero()};
    set_sides(c, 1, BoundaryType::slip);
    c.numerics.density_scaling = gamma;
    GasSolver solver(c, MPI_COMM_WORLD);
    for (int n = 0; n < 3; ++n) solver.advance(dt);
    const double drop = 1.2 * speed / dt * height * (3.0 * gamma + (gamma + 1.0) / 2.0);
    EXPECT_NEAR(solver.side_pressure(2, 0), drop, 1e-7 * drop);
  }
}

// A belt between still gas that nothing else holds: in the end everything moves with it.
TEST(VolumeForcing, drags_gas_along_with_the_surface_velocity_of_a_body) {
  GasCase c = box_case(Vec3(1, 1, 1), {8, 8, 8});
  c.numerics.immersed_boundary = BodyMethod::volume_forcing;
  for (int d = 0; d < 3; ++d) set_sides(c, d, BoundaryType::periodic);
  c.bodies = bodies(
      "[[body]]\nname='belt'\nbox={lower=[-1,-1,0.25],upper=[2,2,0.75]}\n"
      "surface_velocity=[0.3,0,0]\n");
  GasSolver solver(c, MPI_COMM_WORLD);
  for (int n = 0; n < 1000; ++n) solver.advance(1e-3);
  double slowest = 1.0;
  for_each_cell(solver.decomposition().block().size, [&](int i, int j, int k) {
    slowest = std::min(slowest, solver.velocity()[0](i, j, k));
  });
  EXPECT_NEAR(-max_over_ranks(solver.decomposition(), -slowest), 0.3, 1e-3);
}

TEST(VolumeForcing, refuses_bodies_that_move_and_a_given_mean_velocity) {
  expect_contains(refusal_of(column(ball + "motion={translate={velocity=[0,0.1,0]}}\n")),
                  "'ball' moves");
  GasCase c = column();
  set_sides(c, 1, BoundaryType::periodic);
  EXPECT_EQ(refusal_of(c), "no error");
  for (Boundary& boundary : c.boundaries[1]) boundary.mean_velocity = 0.1;
  expect_contains(refusal_of(c), "pressure_gradient");
}

}  // namespace
}  // namespace gasgrain::cfd
