// The solver as a whole on small scenes: conservation, independence of the decomposition and of the
// pressure method, and its errors. Accuracy is verified in tests/verification.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "coupling/shared/error.hpp"
#include "tests/cfd/gas_fixture.hpp"

namespace gasgrain::cfd {
namespace {

using testing::bodies;
using testing::box_case;
using testing::set_moving_heap;
using testing::set_sides;
using testing::side;

constexpr PressureMethod all_methods[] = {PressureMethod::multigrid, PressureMethod::hypre_pfmg,
                                          PressureMethod::hypre_pfmg_rap, PressureMethod::hypre_smg,
                                          PressureMethod::hypre_boomeramg};

// Flow upwards past two bodies, with everything the equations have.
GasCase tower() {
  GasCase c = box_case(Vec3(1.0, 0.6, 2.0), {10, 6, 21});
  c.gas = {.density = 1.2, .viscosity = 0.02, .gravity = Vec3(0.1, 0, -1.0)};
  c.boundaries[0][0].wall_velocity = Vec3(0, 0.2, 0.1);
  set_sides(c, 1, BoundaryType::slip);
  c.boundaries[2][0] = testing::inlet(Vec3(0.1, 0, 0.5));
  c.boundaries[2][1] = side(BoundaryType::outlet);
  c.boundaries[2][1].pressure = 3.0;
  c.bodies = bodies(
      "[[body]]\nname='a'\ncylinder={point=[0.32,0,0.7],axis=[0,1,0],radius=0.17}\n"
      "[[body]]\nname='b'\nsurface_velocity=[0,0.1,0]\nsphere={center=[0.7,0.3,1.2],radius=0.2}\n");
  return c;
}

// A closed bottle: gas only inside a tilted cylinder with a sphere in it, cut cells everywhere.
GasCase bottle() {
  GasCase c = box_case(Vec3(1.0, 1.0, 1.5), {12, 11, 15});
  c.gas = {.density = 1.2, .viscosity = 0.01, .gravity = Vec3(0, 0, -9.81)};
  c.numerics.pressure_tolerance = 1e-13;
  c.bodies = bodies(
      "[[body]]\nname='wall'\ncomplement={cylinder={start=[0.5,0.5,0.11],end=[0.53,0.5,1.37],"
      "radius=0.43}}\n"
      "[[body]]\nname='ball'\nsphere={center=[0.45,0.5,0.5],radius=0.12}\n");
  return c;
}

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

TEST(GasSolver, sealed_bottle_with_moving_grains_is_continuous_to_round_off) {
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

// Largest difference of the owned values of `field` to the same cells of one rank's whole `serial`.
double difference(const GasSolver& parallel, const Field& field, const Field& serial) {
  const Block& block = parallel.decomposition().block();
  double largest = 0.0;
  for_each_cell(block.size, [&](int i, int j, int k) {
    const double other = serial(i + block.lower[0], j + block.lower[1], k + block.lower[2]);
    largest = std::max(largest, std::abs(field(i, j, k) - other));
  });
  return max_over_ranks(parallel.decomposition(), largest);
}

void run_some_steps(GasSolver& solver) {
  set_moving_heap(solver, 0.0, 0.3, 40.0);
  solver.accept_void_fraction_as_old();
  for (int n = 1; n <= 10; ++n) {
    set_moving_heap(solver, 0.02 * n, 0.3, 40.0);
    solver.advance(1e-3);
  }
}

void expect_equal_fields(const GasSolver& a, const GasSolver& b, double tolerance) {
  double speed = 0.0, pressure = 0.0;
  for_each_cell(a.pressure().size(), [&](int i, int j, int k) {
    pressure = std::max(pressure, std::abs(a.pressure()(i, j, k)));
    speed = std::max(speed, std::abs(a.velocity()[2](i, j, k)));
  });
  pressure = max_over_ranks(a.decomposition(), pressure);
  speed = max_over_ranks(a.decomposition(), speed);
  ASSERT_GT(speed, 0.1);
  EXPECT_LT(difference(a, a.pressure(), b.pressure()), tolerance * pressure);
  for (int d = 0; d < 3; ++d) {
    EXPECT_LT(difference(a, a.velocity()[d], b.velocity()[d]), tolerance * speed) << d;
  }
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

TEST(GasSolver, all_pressure_methods_give_the_same_fields) {
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

TEST(GasSolver, a_missed_tolerance_falls_back_to_another_method_and_is_counted) {
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

TEST(GasSolver, every_pressure_method_solves_periodic_and_one_dimensional_grids) {
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

TEST(GasSolver, outlet_pressure_only_shifts_the_pressure) {
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

TEST(GasSolver, a_sealed_chamber_below_a_vented_one_has_its_own_mean_pressure) {
  for (const PressureMethod method : all_methods) {
    const ChamberPressures low = stirred_chambers(method, 7.0);
    const ChamberPressures high = stirred_chambers(method, 107.0);
    EXPECT_NEAR(low.sealed, 0.0, 1e-11);
    EXPECT_NEAR(high.sealed, 0.0, 1e-11);
    EXPECT_NEAR(high.vented - low.vented, 100.0, 1e-6);
    EXPECT_EQ(low.gate, 0.0);
  }
}

TEST(GasSolver, gas_blown_into_a_sealed_vessel_is_a_user_error_on_every_rank) {
  GasCase c = box_case(Vec3(1, 1, 1), {6, 6, 6});
  c.boundaries[2][0] = testing::inlet(Vec3(0, 0, 1));
  try {
    GasSolver solver(c, MPI_COMM_WORLD);
    FAIL();
  } catch (const UserError& error) {
    EXPECT_NE(std::string(error.what()).find("has no outlet"), std::string::npos) << error.what();
  }
}

TEST(GasSolver, too_few_pressure_iterations_are_a_user_error) {
  GasCase c = tower();
  c.numerics.pressure_iterations = 1;
  c.numerics.pressure_fallback = PressureFallback::none;
  GasSolver solver(c, MPI_COMM_WORLD);
  EXPECT_THROW(solver.advance(1e-3), UserError);
}

TEST(GasSolver, an_exploding_velocity_is_a_user_error_that_gives_time_and_step) {
  GasCase c = box_case(Vec3(1, 1, 1), {6, 6, 6});
  for (int d = 0; d < 3; ++d) set_sides(c, d, BoundaryType::periodic);
  GasSolver solver(c, MPI_COMM_WORLD);
  solver.set_velocity([](const Vec3& x) { return Vec3(1e200 * std::sin(6 * x[0]), 0, 1e200); });
  try {
    for (int n = 0; n < 3; ++n) solver.advance(1e-3);
    FAIL();
  } catch (const UserError& error) {
    EXPECT_NE(std::string(error.what()).find("1e+200"), std::string::npos) << error.what();
  }
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
