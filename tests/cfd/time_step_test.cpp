#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "cfd/gas_solver.hpp"
#include "cfd/time_step.hpp"
#include "tests/cfd/drifting_vortices.hpp"
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
  EXPECT_NEAR(solver_of(c).largest_stable_step(), 0.9 * 0.01 / 12.0, 1e-15);
}

// Viscous flow through a box with no-slip sides. At the limit of diffusion alone, without a margin,
// the little convection there is makes it explode within 500 steps.
TEST(LargestStableStep, is_stable_for_thousands_of_steps) {
  GasCase c = testing::box_case(Vec3(1, 1, 2), {12, 12, 24});
  c.boundaries[2][0] = testing::inlet(Vec3(0, 0, 3.0));
  c.boundaries[2][1] = testing::side(BoundaryType::outlet);
  GasSolver solver(c, MPI_COMM_SELF);
  const double dt = solver.step_limits().viscosity;
  double early = 0.0, late = 0.0;
  for (int n = 0; n < 2000; ++n) {
    const double speed = solver.advance(dt).largest_speed;
    (n < 1000 ? early : late) = speed;
  }
  EXPECT_NEAR(late, early, 1e-3 * early);
}

TEST(LargestStableStep, ignores_a_direction_in_which_nothing_varies) {
  GasCase c = testing::box_case(Vec3(1, 0.001, 1), {10, 1, 10});
  testing::set_sides(c, 1, BoundaryType::slip);
  EXPECT_NEAR(solver_of(c).largest_stable_step(), 0.9 * 0.01 / 12.0, 1e-15);
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

TEST(StepLimits, name_the_one_that_binds) {
  GasCase c = testing::box_case(Vec3(1, 1, 1), {10, 10, 10});
  c.gas.gravity = Vec3(0, 0, -10);
  const StepLimits viscous = solver_of(c).step_limits();
  EXPECT_EQ(viscous.binding(), StepLimit::viscosity);
  EXPECT_TRUE(std::isinf(viscous.convection));
  EXPECT_NEAR(viscous.acceleration, std::sqrt(0.25 * 0.1 / 10.0), 1e-15);
  c.numerics.largest_step = 1e-5;
  EXPECT_EQ(solver_of(c).step_limits().binding(), StepLimit::stated);
  c.numerics.largest_step = 1.0;
  c.gas.viscosity = 0.0;
  EXPECT_EQ(solver_of(c).step_limits().binding(), StepLimit::acceleration);
  EXPECT_STREQ(name_of(StepLimit::acceleration), "acceleration");
}

TEST(StepLimits, foresee_what_an_inlet_will_blow) {
  GasCase c = testing::box_case(Vec3(1, 1, 1), {10, 10, 10});
  c.gas.viscosity = 0.0;
  c.boundaries[2][0] = testing::inlet(Vec3(0, 0, 2.0));
  c.boundaries[2][0].factor = {.times = {0, 1}, .values = {0, 3}};
  c.boundaries[2][1] = testing::side(BoundaryType::outlet);
  EXPECT_NEAR(solver_of(c).step_limits().convection, 0.25 * 0.1 / 6.0, 1e-15);
}

TEST(StepLimits, of_two_stages_are_twice_as_long) {
  GasCase c = testing::box_case(Vec3(1, 1, 1), {10, 10, 10});
  c.numerics.time_scheme = TimeScheme::rk2;
  EXPECT_NEAR(solver_of(c).step_limits().viscosity, 0.9 * 0.01 / 6.0, 1e-15);
}

VectorField drifting_vortices(TimeScheme scheme, int steps) {
  return testing::drifting_vortices(steps, [&](GasCase& c) {
    c.gas.viscosity = 0.01;
    c.numerics.time_scheme = scheme;
  });
}

TEST(TimeSchemes, both_are_second_order_and_two_stages_err_less) {
  const VectorField exact = drifting_vortices(TimeScheme::rk2, 400);
  std::array<double, 2> finest{};
  for (const TimeScheme scheme : {TimeScheme::ab2, TimeScheme::rk2}) {
    const double coarse = testing::distance(drifting_vortices(scheme, 25), exact);
    const double fine = testing::distance(drifting_vortices(scheme, 50), exact);
    EXPECT_NEAR(std::log2(coarse / fine), 2.0, 0.15) << coarse << " " << fine;
    finest[scheme == TimeScheme::rk2 ? 1 : 0] = fine;
  }
  EXPECT_LT(finest[1], 0.7 * finest[0]);
}

TEST(TimeSchemes, two_stages_keep_the_momentum_budget) {
  GasCase c = testing::box_case(Vec3(1, 1, 1), {8, 8, 8});
  c.numerics.time_scheme = TimeScheme::rk2;
  c.boundaries[2][0] = testing::inlet(Vec3(0.1, 0, 1));
  c.boundaries[2][1] = testing::side(BoundaryType::outlet);
  c.bodies = testing::bodies("[[body]]\nname='b'\nsphere={center=[0.5,0.5,0.5],radius=0.2}\n");
  GasSolver solver(c, MPI_COMM_WORLD);
  testing::set_moving_heap(solver, 0.0, 0.3, 40.0);
  solver.accept_void_fraction_as_old();
  for (int n = 1; n < 4; ++n) {
    testing::set_moving_heap(solver, 0.05 * n, 0.3, 40.0);
    const MomentumBudget budget = solver.advance(1e-3).momentum;
    EXPECT_LT(testing::imbalance(budget).norm(), 1e-12 * testing::turnover(budget));
    EXPECT_LT(testing::pressure_imbalance(budget).norm(), 1e-12 * testing::turnover(budget));
  }
}

TEST(LargestStableStep, is_infinite_when_nothing_limits_it) {
  GasCase c = testing::box_case(Vec3(1, 1, 1), {4, 4, 4});
  c.gas.viscosity = 0.0;
  EXPECT_TRUE(std::isinf(solver_of(c).largest_stable_step()));
}

}  // namespace
}  // namespace gasgrain::cfd
