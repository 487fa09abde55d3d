// Boundary conditions in the running solver: fluxes, momentum budget, decomposition.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "coupling/shared/error.hpp"
#include "tests/cfd/gas_fixture.hpp"

namespace gasgrain::cfd {
namespace {

using testing::box_case;
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

// Largest difference of a component on owned cells to the whole field of one rank.
double difference(const GasSolver& parallel, const GasSolver& serial, int d) {
  const Block& block = parallel.decomposition().block();
  double largest = 0.0;
  for_each_cell(block.size, [&](int i, int j, int k) {
    const double other =
        serial.velocity()[d](i + block.lower[0], j + block.lower[1], k + block.lower[2]);
    largest = std::max(largest, std::abs(parallel.velocity()[d](i, j, k) - other));
  });
  return max_over_ranks(parallel.decomposition(), largest);
}

TEST(GasBoundary, patches_do_not_depend_on_the_decomposition) {
  GasSolver parallel(jet_and_vent(), MPI_COMM_WORLD), serial(jet_and_vent(), MPI_COMM_SELF);
  for (int n = 0; n < 10; ++n) {
    parallel.advance(2e-3);
    serial.advance(2e-3);
  }
  for (int d = 0; d < 3; ++d) EXPECT_LT(difference(parallel, serial, d), 1e-8) << d;
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
  for (int d = 0; d < 3; ++d) EXPECT_EQ(difference(a, b, d), 0.0) << d;
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
  EXPECT_THROW(solver.advance(0.1), UserError);
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
