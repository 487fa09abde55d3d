// The solver as a whole on small scenes: conservation, independence of the decomposition, and its
// errors. The pressure: gas_pressure_test.cpp. Accuracy is verified in tests/verification.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/cfd/gas_scenes.hpp"
#include "tests/shared/error_checks.hpp"

namespace gasgrain::cfd {
namespace {

using testing::bottle;
using testing::box_case;
using testing::expect_equal_fields;
using testing::run_some_steps;
using testing::set_moving_heap;
using testing::set_sides;
using testing::tower;

TEST(GasSolver, momentum_budget_closes_to_round_off) {
  GasSolver solver(tower(), MPI_COMM_WORLD);
  set_moving_heap(solver, 0.0, 0.3, 40.0);
  solver.accept_void_fraction_as_old();
  double phase = 0.0;
  for (const double dt : {1e-3, 2e-3, 1.5e-3, 1.5e-3, 1e-3}) {
    set_moving_heap(solver, phase += 0.05, 0.3, 40.0);
    const MomentumBudget budget = solver.advance(dt).momentum;
    const double scale = testing::turnover(budget);
    EXPECT_GT(budget.body.norm(), 1e-5 * scale);
    EXPECT_GT(budget.viscous.norm(), 1e-6 * scale);
    EXPECT_GT(budget.drag.norm(), 1e-3 * scale);
    EXPECT_LT(testing::imbalance(budget).norm(), 1e-12 * scale);
    EXPECT_LT(testing::pressure_imbalance(budget).norm(), 1e-12 * scale);
  }
}

TEST(GasSolver, without_bodies_the_pressure_acts_on_the_sides_only) {
  GasCase c = tower();
  c.bodies.clear();
  GasSolver solver(c, MPI_COMM_WORLD);
  set_moving_heap(solver, 0.4, 0.3, 40.0);
  const MomentumBudget budget = solver.advance(1e-3).momentum;
  EXPECT_LT(budget.body_pressure.norm(), 1e-12 * testing::turnover(budget));
  EXPECT_EQ(budget.body.norm(), 0.0);
  const double dt = 1e-3, area = 0.6;
  EXPECT_NEAR(budget.side_pressure[2], dt * area * (solver.side_pressure(2, 0) - 3.0),
              1e-12 * testing::turnover(budget));
}

TEST(GasSolver, outflow_equals_inflow_minus_the_growth_of_the_voids) {
  GasSolver solver(tower(), MPI_COMM_WORLD);
  set_moving_heap(solver, 0.0, 0.3, 40.0);
  solver.accept_void_fraction_as_old();
  set_moving_heap(solver, 0.1, 0.3, 40.0);
  const StepReport report = solver.advance(1e-3);
  EXPECT_NEAR(solver.side_flux(2, 0), 0.5 * solver.side_open_area(2, 0), 1e-12);
  EXPECT_NEAR(solver.side_flux(2, 1), solver.side_flux(2, 0), 1e-7);
  EXPECT_LT(report.divergence, 1e-7);
  EXPECT_EQ(report.removed_mean, 0.0);
}

TEST(GasSolver, gas_at_rest_stays_at_rest_between_resting_grains) {
  GasCase c = bottle();
  c.bodies.clear();
  GasSolver solver(c, MPI_COMM_WORLD);
  set_moving_heap(solver, 0.7, 0.2, 1000.0);
  for (Field& momentum : solver.grains().exchange_momentum) momentum.fill(0.0);
  solver.accept_void_fraction_as_old();
  StepReport report;
  for (int n = 0; n < 3; ++n) report = solver.advance(1e-3);
  // the weight of 18 Pa of gas is carried by the pressure up to the round-off of its gradient
  EXPECT_LT(report.largest_speed, 1e-13);
}

TEST(GasSolver, fields_do_not_depend_on_the_decomposition) {
  GasSolver parallel(tower(), MPI_COMM_WORLD), serial(tower(), MPI_COMM_SELF);
  run_some_steps(parallel);
  run_some_steps(serial);
  expect_equal_fields(parallel, serial, 1e-8);
  EXPECT_NEAR(parallel.side_pressure(2, 0) / serial.side_pressure(2, 0), 1.0, 1e-8);
}

TEST(GasSolver, fields_do_not_depend_on_how_thin_the_blocks_are) {
  GasCase c = tower();
  c.grid.cells = {10, 6, 4};  // one layer per block on four ranks
  c.bodies.resize(1);
  GasCase cut = c;
  int ranks = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  cut.numerics.ranks = {1, 1, ranks};
  GasSolver parallel(cut, MPI_COMM_WORLD), serial(c, MPI_COMM_SELF);
  run_some_steps(parallel);
  run_some_steps(serial);
  expect_equal_fields(parallel, serial, 1e-8);
}

TEST(GasSolver, a_missing_direction_changes_nothing) {
  GasCase c = tower();
  c.bodies.resize(1);  // the cylinder along y
  c.boundaries[0][0].wall_velocity = Vec3(0, 0, 0.1);
  GasCase flat = c;
  flat.grid.cells[1] = 1;
  GasSolver deep(c, MPI_COMM_SELF), thin(flat, MPI_COMM_SELF);
  for (int n = 0; n < 20; ++n) {
    deep.advance(2e-3);
    thin.advance(2e-3);
  }
  for_each_cell(thin.pressure().size(), [&](int i, int, int k) {
    EXPECT_NEAR(deep.velocity()[0](i, 2, k), thin.velocity()[0](i, 0, k), 1e-8);
    EXPECT_NEAR(deep.velocity()[2](i, 2, k), thin.velocity()[2](i, 0, k), 1e-8);
    EXPECT_EQ(thin.velocity()[1](i, 0, k), 0.0);
  });
}

TEST(GasSolver, gas_blown_into_a_sealed_vessel_is_a_user_error_on_every_rank) {
  GasCase c = box_case(Vec3(1, 1, 1), {6, 6, 6});
  c.boundaries[2][0] = testing::inlet(Vec3(0, 0, 1));
  expect_contains(user_error([&] { GasSolver(c, MPI_COMM_WORLD); }), "has no outlet");
}

TEST(GasSolver, an_exploding_velocity_is_a_user_error_that_gives_time_and_step) {
  GasCase c = box_case(Vec3(1, 1, 1), {6, 6, 6});
  for (int d = 0; d < 3; ++d) set_sides(c, d, BoundaryType::periodic);
  GasSolver solver(c, MPI_COMM_WORLD);
  solver.set_velocity([](const Vec3& x) { return Vec3(1e200 * std::sin(6 * x[0]), 0, 1e200); });
  const std::string error = user_error([&] {
    for (int n = 0; n < 3; ++n) solver.advance(1e-3);
  });
  expect_contains(error, "1e+200");
}

TEST(GasSolver, grains_feel_the_opposite_of_what_the_gas_feels) {
  // Forces gathered at the cells with sample_at_cells against the budget's rows.
  GasSolver solver(tower(), MPI_COMM_WORLD);
  set_moving_heap(solver, 0.2, 0.3, 40.0);
  solver.accept_void_fraction_as_old();
  set_moving_heap(solver, 0.25, 0.3, 40.0);
  const double dt = 1e-3;
  const MomentumBudget budget = solver.advance(dt).momentum;
  VectorField velocity, gradient;
  solver.sample_at_cells(velocity, gradient);
  const GrainPhase& grains = solver.grains();
  const double cell = solver.decomposition().grid().cell_volume();
  std::vector<double> on_grains(6, 0.0);
  for_each_cell(grains.void_fraction.size(), [&](int i, int j, int k) {
    const std::ptrdiff_t n = grains.void_fraction.index(i, j, k);
    const double open = cell * (1.0 - solver.walls().wall_fraction[n]);
    for (int d = 0; d < 3; ++d) {
      on_grains[d] -= dt * open * (1.0 - grains.void_fraction[n]) * gradient[d][n];
      on_grains[3 + d] +=
          dt * open *
          (grains.momentum_exchange[n] * velocity[d][n] - grains.exchange_momentum[d][n]);
    }
  });
  sum_over_ranks(solver.decomposition(), on_grains);
  for (int d = 0; d < 3; ++d) {
    EXPECT_NEAR(on_grains[d], budget.pressure_on_grains[d], 1e-12 * testing::turnover(budget));
    EXPECT_NEAR(on_grains[3 + d], -budget.drag[d], 1e-12 * testing::turnover(budget));
  }
}

}  // namespace
}  // namespace gasgrain::cfd
