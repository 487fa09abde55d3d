// Boundary conditions in the running solver: fluxes, momentum budget, decomposition.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "coupling/shared/error.hpp"
#include "tests/cfd/gas_scenes.hpp"
#include "tests/shared/error_checks.hpp"

namespace gasgrain::cfd {
namespace {

using testing::box_case;
using testing::difference;
using testing::set_moving_heap;
using testing::side;

BoundaryPatch patch_in_box(const std::string& name, int direction, int at_side, const Vec3& lower,
                           const Vec3& upper, const Boundary& condition) {
  const std::vector<Body> region =
      testing::bodies("[[body]]\nname='r'\nbox={lower=[" + std::to_string(lower[0]) + "," +
                      std::to_string(lower[1]) + "," + std::to_string(lower[2]) + "],upper=[" +
                      std::to_string(upper[0]) + "," + std::to_string(upper[1]) + "," +
                      std::to_string(upper[2]) + "]}\n");
  return {name, direction, at_side, region.front().shape, condition};
}

// A jet through the bottom plate and a vent in one side wall, with everything else closed.
GasCase jet_and_vent() {
  GasCase c = box_case(Vec3(1.0, 0.6, 2.0), {10, 6, 20});
  c.gas = {.density = 1.2, .viscosity = 0.02, .gravity = Vec3(0.1, 0, -1.0)};
  c.boundaries[0][0].wall_velocity = Vec3(0, 0.2, 0.1);
  Boundary vent = side(BoundaryType::outlet);
  vent.pressure = 3.0;
  c.patches = {patch_in_box("jet", 2, 0, Vec3(0.3, 0.2, -1), Vec3(0.6, 0.4, 1),
                            testing::inlet(Vec3(0.1, 0, 2.0))),
               patch_in_box("vent", 0, 1, Vec3(0, 0.1, 1.5), Vec3(2, 0.5, 1.9), vent)};
  return c;
}

constexpr double jet_area = 0.3 * 0.2, vent_area = 0.4 * 0.4;

TEST(GasBoundary, patches_take_part_in_the_momentum_budget) {
  GasSolver solver(jet_and_vent(), MPI_COMM_WORLD);
  set_moving_heap(solver, 0.0, 0.3, 40.0);
  solver.accept_void_fraction_as_old();
  for (int n = 1; n <= 5; ++n) {
    set_moving_heap(solver, 0.05 * n, 0.3, 40.0);
    const MomentumBudget budget = solver.advance(1e-3).momentum;
    EXPECT_LT(testing::imbalance(budget).norm(), 1e-12 * testing::turnover(budget));
    EXPECT_LT(testing::pressure_imbalance(budget).norm(), 1e-12 * testing::turnover(budget));
    EXPECT_LT(budget.body_pressure.norm(), 1e-12 * testing::turnover(budget));
  }
  EXPECT_NEAR(solver.side_flux(2, 0), 2.0 * jet_area, 1e-12);
}

TEST(GasBoundary, what_enters_by_the_jet_leaves_by_the_vent) {
  GasSolver solver(jet_and_vent(), MPI_COMM_WORLD);
  StepReport report;
  for (int n = 0; n < 20; ++n) report = solver.advance(2e-3);
  EXPECT_LT(report.divergence, 1e-8);
  EXPECT_EQ(report.removed_mean, 0.0);
  EXPECT_NEAR(solver.side_flux(2, 0), 2.0 * jet_area, 1e-12);
  EXPECT_NEAR(solver.side_flux(0, 1), 2.0 * jet_area, 1e-8);
  EXPECT_EQ(solver.side_flux(2, 1), 0.0);
  // only the vent is open, so its faces carry the flux at this mean speed at least
  EXPECT_GT(report.largest_speed, 2.0 * jet_area / vent_area);
}

TEST(GasBoundary, patches_do_not_depend_on_the_decomposition) {
  GasSolver parallel(jet_and_vent(), MPI_COMM_WORLD), serial(jet_and_vent(), MPI_COMM_SELF);
  for (int n = 0; n < 10; ++n) {
    parallel.advance(2e-3);
    serial.advance(2e-3);
  }
  for (int d = 0; d < 3; ++d)
    EXPECT_LT(difference(parallel, parallel.velocity()[d], serial.velocity()[d]), 1e-8) << d;
}

TEST(GasBoundary, a_side_made_of_patches_is_the_side_itself) {
  GasCase whole = box_case(Vec3(1, 1, 1), {8, 8, 8});
  whole.boundaries[2][0] = testing::inlet(Vec3(0.1, 0, 1));
  whole.boundaries[2][1] = side(BoundaryType::outlet);
  GasCase parts = whole;
  parts.boundaries[2][0] = parts.boundaries[2][1] = side(BoundaryType::no_slip);
  parts.patches = {
      patch_in_box("in", 2, 0, Vec3(-1, -1, -1), Vec3(2, 2, 0.5), whole.boundaries[2][0]),
      patch_in_box("out", 2, 1, Vec3(-1, -1, 0.5), Vec3(2, 2, 2), whole.boundaries[2][1])};
  GasSolver a(whole, MPI_COMM_SELF), b(parts, MPI_COMM_SELF);
  for (int n = 0; n < 5; ++n) {
    a.advance(1e-3);
    b.advance(1e-3);
  }
  for (int d = 0; d < 3; ++d) EXPECT_EQ(difference(a, a.velocity()[d], b.velocity()[d]), 0.0) << d;
}

TEST(GasBoundary, a_table_drives_the_flux_at_the_end_of_the_step) {
  GasCase c = box_case(Vec3(1, 1, 1), {6, 6, 6});
  c.boundaries[2][0] = testing::inlet(Vec3(0, 0, 2));
  c.boundaries[2][0].factor = {.times = {0, 0.1}, .values = {0, 1}};
  c.boundaries[2][1] = side(BoundaryType::outlet);
  GasSolver solver(c, MPI_COMM_WORLD);
  EXPECT_EQ(solver.side_flux(2, 0), 0.0);
  for (int n = 0; n < 3; ++n) solver.advance(1e-3);
  EXPECT_NEAR(solver.side_flux(2, 0), 2 * 0.03, 1e-12);
  EXPECT_NEAR(solver.side_flux(2, 1), 2 * 0.03, 1e-8);
  solver.advance(0.09);
  expect_contains(user_error([&] { solver.advance(0.1); }), "time_table ends at 0.1 s");
}

TEST(GasBoundary, gas_from_still_surroundings_enters_with_bernoullis_speed) {
  // A frictionless duct of length 1 between two pressures: L du/dt = dp/rho - u^2/2.
  GasCase c = box_case(Vec3(0.2, 0.2, 1.0), {1, 1, 8});
  c.gas = {.density = 1.2, .viscosity = 0.0};
  testing::set_sides(c, 0, BoundaryType::slip);
  testing::set_sides(c, 1, BoundaryType::slip);
  testing::set_sides(c, 2, BoundaryType::outlet);
  c.boundaries[2][0].pressure = 5.0;
  const double final_speed = std::sqrt(2.0 * 5.0 / 1.2), end = 1.5;
  GasSolver solver(c, MPI_COMM_WORLD);
  StepReport report;
  for (int n = 0; n < 1500; ++n) report = solver.advance(end / 1500);
  const double exact = final_speed * std::tanh(final_speed * end / 2.0);
  EXPECT_NEAR(solver.side_flux(2, 1) / 0.04, exact, 0.003 * exact);
  EXPECT_NEAR(report.backflow, solver.side_flux(2, 0), 1e-12);
  EXPECT_LT(testing::imbalance(report.momentum).norm(), 1e-12 * testing::turnover(report.momentum));

  c.boundaries[2][0].backflow = Backflow::moving;  // nothing slows it down: u = dp t/(rho L)
  GasSolver free(c, MPI_COMM_WORLD);
  for (int n = 0; n < 150; ++n) free.advance(end / 1500);
  EXPECT_NEAR(free.side_flux(2, 1) / 0.04, 5.0 / 1.2 * 0.15, 1e-9);
}

// Kinetic energy of this case's gas over density, m^5/s^2.
double kinetic_energy(const GasSolver& solver) {
  double sum = 0.0;
  for (int d = 0; d < 3; ++d) {
    for_each_face(solver.decomposition(), d, [&](int i, int j, int k) {
      const double u = solver.velocity()[d](i, j, k);
      sum += 0.5 * u * u * solver.decomposition().grid().cell_volume();
    });
  }
  return sum_over_ranks(solver.decomposition(), sum);
}

TEST(GasBoundary, a_vortex_leaves_through_an_outlet_without_a_gain_of_energy) {
  // Its swirl of 3 m/s exceeds the stream of 1 m/s, so gas flows back in while it passes.
  GasCase c = box_case(Vec3(1, 1, 1), {32, 1, 32});
  c.gas.viscosity = 1e-4;
  c.numerics.pressure_tolerance = 1e-6;
  testing::set_sides(c, 0, BoundaryType::slip);
  testing::set_sides(c, 1, BoundaryType::slip);
  c.boundaries[2][0] = testing::inlet(Vec3(0, 0, 1));
  c.boundaries[2][1] = side(BoundaryType::outlet);
  GasSolver solver(c, MPI_COMM_WORLD);
  const double core = 0.08;
  solver.set_velocity([&](const Vec3& x) {
    const Vec3 r = x - Vec3(0.5, 0, 0.6);
    const double swirl = 3.0 * std::exp(0.5 - 0.5 * (r[0] * r[0] + r[2] * r[2]) / (core * core));
    return Vec3(swirl * r[2] / core, 0, 1.0 - swirl * r[0] / core);
  });
  solver.advance(1e-4);
  const double at_first = kinetic_energy(solver);
  double largest = at_first, largest_backflow = 0.0;
  while (solver.time() < 2.0) {
    largest_backflow =
        std::max(largest_backflow, solver.advance(solver.largest_stable_step()).backflow);
    largest = std::max(largest, kinetic_energy(solver));
  }
  EXPECT_GT(largest_backflow, 0.02);
  EXPECT_LT(largest, 1.02 * at_first);
  EXPECT_NEAR(kinetic_energy(solver), 0.5, 0.02);  // the stream alone
}

// Channel of height 1 between z_lower and z_upper, periodic along x, with a rod across it.
GasCase periodic_channel(int cells) {
  GasCase c = box_case(Vec3(1, 0.5, 1), {cells, 2, cells});
  testing::set_sides(c, 0, BoundaryType::periodic);
  testing::set_sides(c, 1, BoundaryType::slip);
  c.numerics.pressure_tolerance = 1e-13;
  return c;
}

GasCase channel_with_rod() {
  GasCase c = periodic_channel(12);
  c.bodies = testing::bodies(
      "[[body]]\nname='rod'\ncylinder={point=[0.5,0,0.45],axis=[0,1,0],radius=0.2}\n");
  return c;
}

TEST(GasBoundary, a_pressure_gradient_drives_the_flow_of_a_body_force) {
  GasCase forced = channel_with_rod(), driven = forced;
  forced.gas.gravity = Vec3(3, 0, 0);
  driven.boundaries[0][0].pressure_gradient = -3.0;
  GasSolver a(forced, MPI_COMM_SELF), b(driven, MPI_COMM_SELF);
  for (int n = 0; n < 10; ++n) {
    a.advance(5e-4);
    b.advance(5e-4);
  }
  EXPECT_GT(a.side_flux(0, 0), 1e-3);
  for (int d = 0; d < 3; ++d) EXPECT_LT(difference(a, a.velocity()[d], b.velocity()[d]), 1e-12);
}

TEST(GasBoundary, a_driving_gradient_acts_on_gas_grains_and_bodies) {
  GasCase c = channel_with_rod();
  c.boundaries[0][0].pressure_gradient = -3.0;
  GasSolver solver(c, MPI_COMM_WORLD);
  set_moving_heap(solver, 0.0, 0.3, 40.0);
  solver.accept_void_fraction_as_old();
  const double dt = 1e-3;
  for (int n = 1; n < 4; ++n) {
    set_moving_heap(solver, 0.05 * n, 0.3, 40.0);
    const MomentumBudget budget = solver.advance(dt).momentum;
    EXPECT_LT(testing::imbalance(budget).norm(), 1e-12 * testing::turnover(budget));
    EXPECT_LT(testing::pressure_imbalance(budget).norm(), 1e-12 * testing::turnover(budget));
    EXPECT_NEAR(budget.side_pressure[0], 3.0 * 0.5 * dt, 1e-15);  // box of 0.5 m^3
    const Vec3 on_rod = solver.body_loads().front().pressure;
    EXPECT_NEAR(on_rod[0] * dt, -budget.body_pressure[0], 1e-12 * testing::turnover(budget));
  }
}

TEST(GasBoundary, a_prescribed_mean_flow_finds_its_pressure_gradient) {
  GasCase c = periodic_channel(16);
  c.grid.cells[0] = c.grid.cells[1] = 1;
  c.boundaries[0][0].mean_velocity = 0.5;
  GasSolver solver(c, MPI_COMM_WORLD);
  StepReport report;
  while (solver.time() < 1.0) {
    report = solver.advance(solver.largest_stable_step());
    ASSERT_NEAR(solver.side_flux(0, 0), 0.5 * 0.5, 1e-13);
  }
  // 12 mu q / H^2; the discrete parabola through n cells carries 1 + 2/n^2 of the exact flow
  EXPECT_NEAR(report.driving_gradient[0], -6.0 / (1.0 + 2.0 / 256.0), 1e-3);
}

TEST(GasBoundary, a_prescribed_mean_flow_is_kept_around_a_body) {
  GasCase c = channel_with_rod();
  c.boundaries[0][0].mean_velocity = 0.5;
  GasSolver solver(c, MPI_COMM_WORLD);
  StepReport report;
  for (int n = 0; n < 400; ++n) report = solver.advance(5e-4);
  EXPECT_NEAR(solver.side_flux(0, 0), 0.25, 1e-6);
  EXPECT_LT(report.driving_gradient[0], -6.0);  // more than without the rod
  EXPECT_LT(testing::imbalance(report.momentum).norm(), 1e-12 * testing::turnover(report.momentum));
}

TEST(GasBoundary, a_reference_pressure_is_the_mean_of_a_sealed_region) {
  GasCase c = box_case(Vec3(1, 1, 1), {6, 6, 6});
  c.gas.gravity = Vec3(0, 0, -9.81);
  GasSolver plain(c, MPI_COMM_WORLD);
  c.numerics.reference_pressure = 101325.0;
  GasSolver referred(c, MPI_COMM_WORLD);
  for (int n = 0; n < 3; ++n) {
    plain.advance(1e-3);
    referred.advance(1e-3);
  }
  EXPECT_NEAR(referred.side_pressure(2, 0), 101325.0 + 0.5 * 9.81, 1e-8);
  EXPECT_NEAR(plain.side_pressure(2, 0), 0.5 * 9.81, 1e-8);
}

void expect_refused(const GasCase& c, const std::string& part) {
  expect_contains(user_error([&] { GasSolver(c, MPI_COMM_WORLD); }), part);
}

TEST(GasBoundary, conditions_that_contradict_each_other_are_refused_with_numbers) {
  GasCase c = jet_and_vent();
  c.patches.pop_back();
  expect_refused(c, "no outlet, but 0.12 m^3/s blow into it (boundary.patch 'jet' on z_lower");
  c = jet_and_vent();
  c.bodies = testing::bodies("[[body]]\nname='lid'\nbox={lower=[0.8,-1,1.2],upper=[2,2,2.5]}\n");
  expect_refused(c, "boundary.patch 'vent' on x_upper: bodies cover all of its 16 faces");
  c.bodies = testing::bodies("[[body]]\nname='gate'\nbox={lower=[-1,-1,0.95],upper=[2,2,1.25]}\n");
  expect_refused(c, "has no outlet, but 0.12 m^3/s");
}

TEST(GasBoundary, a_plate_that_oscillates_in_its_plane_drives_stokes_layer) {
  // Stokes's second problem: u = exp(-k z) cos(w t - k z), k = sqrt(w / (2 nu)); with nu = 1 and
  // w = 2 pi / T the gap of 6 / k hides the wall opposite (exp(-6) = 0.25 %).
  const double k = 10.0, omega = 2.0 * k * k, period = 2.0 * M_PI / omega;
  GasCase c = box_case(Vec3(1, 1, 6.0 / k), {1, 1, 30});
  testing::set_sides(c, 0, BoundaryType::periodic);
  testing::set_sides(c, 1, BoundaryType::slip);
  c.boundaries[2][0].wall_velocity = Vec3(1, 0, 0);
  TimeTable& table = c.boundaries[2][0].factor;
  for (int n = 0; n < 200; ++n) {
    table.times.push_back(period * n / 200);
    table.values.push_back(std::cos(2.0 * M_PI * n / 200));
  }
  table.period = period;
  GasSolver solver(c, MPI_COMM_SELF);
  const double end = 2.0 * period;
  while (solver.time() < end * (1 - 1e-12)) {
    solver.advance(std::min(solver.largest_stable_step(), end - solver.time()));
  }
  for (int cell = 0; cell < 30; cell += 3) {
    const double z = (cell + 0.5) / 30 * 6.0 / k;
    const double exact = std::exp(-k * z) * std::cos(omega * end - k * z);
    EXPECT_NEAR(solver.velocity()[0](0, 0, cell), exact, 0.01) << z;
  }
}

}  // namespace
}  // namespace gasgrain::cfd
