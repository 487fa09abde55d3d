#include <gtest/gtest.h>

#include <cmath>

#include "cfd/gas_solver.hpp"
#include "cfd/time_step.hpp"
#include "tests/cfd/gas_fixture.hpp"

namespace gasgrain::cfd {
namespace {

TEST(AdamsBashforth, first_step_is_euler) {
  const AdamsBashforth w = adams_bashforth(0.1, 0.0);
  EXPECT_EQ(w.now, 1.0);
  EXPECT_EQ(w.before, 0.0);
}

TEST(AdamsBashforth, integrates_a_linear_slope_exactly_with_uneven_steps) {
  // y' = 2 t: the slopes at the two past times extrapolate it exactly
  double t = 0.3, y = t * t, before = 0.2;
  for (const double dt : {0.1, 0.25, 0.05}) {
    const double previous = t - before;
    const AdamsBashforth w = adams_bashforth(dt, previous);
    y += dt * (w.now * 2 * t + w.before * 2 * before);
    before = t;
    t += dt;
    EXPECT_NEAR(y, t * t, 1e-14);
  }
}

GasSolver solver_of(const GasCase& gas_case) {
  return GasSolver(gas_case, MPI_COMM_WORLD);
}

TEST(LargestStableStep, is_the_viscous_limit_at_rest) {
  GasCase c = testing::box_case(Vec3(1, 1, 1), {10, 10, 10});
  EXPECT_NEAR(solver_of(c).largest_stable_step(), 0.01 / 12.0, 1e-15);
}

TEST(LargestStableStep, ignores_a_direction_in_which_nothing_varies) {
  GasCase c = testing::box_case(Vec3(1, 0.001, 1), {10, 1, 10});
  testing::set_sides(c, 1, BoundaryType::slip);
  EXPECT_NEAR(solver_of(c).largest_stable_step(), 0.01 / 12.0, 1e-15);
}

TEST(LargestStableStep, keeps_the_courant_number) {
  GasCase c = testing::box_case(Vec3(1, 1, 1), {10, 10, 10});
  c.gas.viscosity = 0.0;
  c.boundaries[2][0] = testing::inlet(Vec3(0, 0, 2.0));
  c.boundaries[2][1] = testing::side(BoundaryType::outlet);
  EXPECT_NEAR(solver_of(c).largest_stable_step(), 0.25 * 0.1 / 2.0, 1e-15);
}

TEST(LargestStableStep, foresees_what_gravity_does_to_gas_at_rest) {
  GasCase c = testing::box_case(Vec3(1, 1, 1), {10, 10, 10});
  c.gas.viscosity = 0.0;
  c.gas.gravity = Vec3(0, 0, -10);
  // g dt^2 = 0.25 h
  EXPECT_NEAR(solver_of(c).largest_stable_step(), std::sqrt(0.25 * 0.1 / 10.0), 1e-15);
}

TEST(LargestStableStep, is_infinite_when_nothing_limits_it) {
  GasCase c = testing::box_case(Vec3(1, 1, 1), {4, 4, 4});
  c.gas.viscosity = 0.0;
  EXPECT_TRUE(std::isinf(solver_of(c).largest_stable_step()));
}

}  // namespace
}  // namespace gasgrain::cfd
