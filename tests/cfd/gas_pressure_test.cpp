// The pressure: every method of solving for it, what steps in when one fails, and regions of gas
// with a pressure of their own.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/cfd/gas_scenes.hpp"
#include "tests/shared/error_checks.hpp"

namespace gasgrain::cfd {
namespace {

using testing::bodies;
using testing::bottle;
using testing::box_case;
using testing::expect_equal_fields;
using testing::run_some_steps;
using testing::set_moving_heap;
using testing::set_sides;
using testing::side;
using testing::tower;

constexpr PressureMethod all_methods[] = {PressureMethod::multigrid, PressureMethod::hypre_pfmg,
                                          PressureMethod::hypre_pfmg_rap, PressureMethod::hypre_smg,
                                          PressureMethod::hypre_boomeramg};

TEST(GasPressure, sealed_bottle_with_moving_grains_is_continuous_to_round_off) {
  for (const PressureMethod method : all_methods) {
    GasCase c = bottle();
    c.numerics.pressure_solver = method;
    GasSolver solver(c, MPI_COMM_WORLD);
    set_moving_heap(solver, 0.0, 0.35, 1000.0);
    solver.accept_void_fraction_as_old();
    for (int n = 1; n <= 5; ++n) {
      set_moving_heap(solver, 0.03 * n, 0.35, 1000.0);
      const StepReport report = solver.advance(2e-3);
      EXPECT_TRUE(report.pressure.fallbacks == 0 || method == PressureMethod::hypre_pfmg_rap);
      EXPECT_LT(report.divergence, 1e-12);
      EXPECT_LT(report.removed_mean, 1e-12);
      EXPECT_LT(testing::imbalance(report.momentum).norm(),
                1e-12 * testing::turnover(report.momentum));
    }
  }
}

TEST(GasPressure, all_pressure_methods_give_the_same_fields) {
  GasSolver multigrid(tower(), MPI_COMM_SELF);
  run_some_steps(multigrid);
  for (const PressureMethod method : all_methods) {
    GasCase c = tower();
    c.numerics.pressure_solver = method;
    GasSolver solver(c, MPI_COMM_WORLD);
    run_some_steps(solver);
    expect_equal_fields(solver, multigrid, 1e-8);
  }
}

TEST(GasPressure, a_missed_tolerance_falls_back_to_another_method_and_is_counted) {
  GasSolver without_limit(tower(), MPI_COMM_SELF);
  run_some_steps(without_limit);
  for (const PressureFallback fallback :
       {PressureFallback::hypre_boomeramg, PressureFallback::hypre_pfmg}) {
    GasCase c = tower();
    c.numerics.pressure_iterations = 1;
    c.numerics.pressure_fallback = fallback;
    GasSolver solver(c, MPI_COMM_WORLD);
    set_moving_heap(solver, 0.0, 0.3, 40.0);
    solver.accept_void_fraction_as_old();
    for (int n = 1; n <= 10; ++n) {
      set_moving_heap(solver, 0.02 * n, 0.3, 40.0);
      const PressureReport report = solver.advance(1e-3).pressure;
      EXPECT_EQ(report.fallbacks, 1);
      EXPECT_GT(report.iterations, 2);
      EXPECT_LE(report.residual, c.numerics.pressure_tolerance);
    }
    expect_equal_fields(solver, without_limit, 1e-8);
  }
}

TEST(GasPressure, every_pressure_method_solves_periodic_and_one_dimensional_grids) {
  for (const Index3& cells : {Index3{8, 1, 7}, Index3{1, 1, 12}, Index3{7, 9, 6}}) {
    for (const PressureMethod method : all_methods) {
      GasCase c = box_case(Vec3(1, 1, 1), cells);
      c.numerics.pressure_solver = method;
      set_sides(c, 0, BoundaryType::periodic);
      set_sides(c, 1, BoundaryType::periodic);
      GasSolver solver(c, MPI_COMM_SELF);
      set_moving_heap(solver, 0.0, 0.3, 40.0);
      solver.accept_void_fraction_as_old();
      set_moving_heap(solver, 0.1, 0.3, 40.0);
      const StepReport report = solver.advance(1e-4);
      EXPECT_TRUE(report.pressure.fallbacks == 0 || method == PressureMethod::hypre_smg);
      EXPECT_LT(report.divergence, 1e-10);
      EXPECT_LT(report.removed_mean, 1e-12);
    }
  }
}

TEST(GasPressure, outlet_pressure_only_shifts_the_pressure) {
  GasCase low = tower(), high = tower();
  high.boundaries[2][1].pressure = low.boundaries[2][1].pressure + 100.0;
  GasSolver a(low, MPI_COMM_WORLD), b(high, MPI_COMM_WORLD);
  run_some_steps(a);
  run_some_steps(b);
  EXPECT_NEAR(b.side_pressure(2, 0) - a.side_pressure(2, 0), 100.0, 1e-5);
  EXPECT_NEAR(b.side_flux(2, 1), a.side_flux(2, 1), 1e-7);
}

// A box cut in two by a plate; the upper chamber has an outlet.
GasCase two_chambers() {
  GasCase c = box_case(Vec3(1, 0.5, 2), {6, 3, 16});
  c.boundaries[2][1] = side(BoundaryType::outlet);
  c.bodies = bodies("[[body]]\nname='gate'\nbox={lower=[-1,-1,0.93],upper=[2,2,1.21]}\n");
  return c;
}

struct ChamberPressures {
  double sealed, vented, gate;  // means over cells, Pa; of |p| in the gate
};

ChamberPressures stirred_chambers(PressureMethod method, double outlet_pressure) {
  GasCase c = two_chambers();
  c.numerics.pressure_solver = method;
  c.boundaries[0][0].wall_velocity = Vec3(0, 0, 1);  // stirs both
  c.boundaries[2][1].pressure = outlet_pressure;
  GasSolver solver(c, MPI_COMM_WORLD);
  StepReport report;
  for (int n = 0; n < 20; ++n) report = solver.advance(1e-3);
  EXPECT_GT(report.largest_speed, 1e-2);
  EXPECT_LT(report.removed_mean, 1e-12);
  std::vector<double> sums(6, 0.0);  // and the numbers of cells
  const int first_layer = solver.decomposition().block().lower[2];
  for_each_cell(solver.pressure().size(), [&](int i, int j, int k) {
    const double p = solver.pressure()(i, j, k);
    const bool solid = solver.walls().wall_fraction(i, j, k) == 1.0;
    const int part = solid ? 2 : k + first_layer < 8 ? 0 : 1;
    sums[part] += solid ? std::abs(p) : p;
    sums[3 + part] += 1.0;
  });
  sum_over_ranks(solver.decomposition(), sums);
  return {sums[0] / sums[3], sums[1] / sums[4], sums[2] / sums[5]};
}

TEST(GasPressure, a_sealed_chamber_below_a_vented_one_has_its_own_mean_pressure) {
  for (const PressureMethod method : all_methods) {
    const ChamberPressures low = stirred_chambers(method, 7.0);
    const ChamberPressures high = stirred_chambers(method, 107.0);
    EXPECT_NEAR(low.sealed, 0.0, 1e-11);
    EXPECT_NEAR(high.sealed, 0.0, 1e-11);
    EXPECT_NEAR(high.vented - low.vented, 100.0, 1e-6);
    EXPECT_EQ(low.gate, 0.0);
  }
}

TEST(GasPressure, too_few_pressure_iterations_are_a_user_error) {
  GasCase c = tower();
  c.numerics.pressure_iterations = 1;
  c.numerics.pressure_fallback = PressureFallback::none;
  GasSolver solver(c, MPI_COMM_WORLD);
  expect_contains(user_error([&] { solver.advance(1e-3); }), "the pressure equation is not solved");
}

}  // namespace
}  // namespace gasgrain::cfd
