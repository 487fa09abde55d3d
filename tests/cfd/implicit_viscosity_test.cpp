// Implicit viscosity against exact and explicit solutions at steps far beyond the explicit limit.
#include "cfd/implicit_viscosity.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/cfd/drifting_vortices.hpp"
#include "tests/cfd/gas_fixture.hpp"

namespace gasgrain::cfd {
namespace {

using testing::bodies;
using testing::box_case;
using testing::set_sides;
using testing::side;

GasCase implicit(GasCase c) {
  c.numerics.viscosity = Viscosity::implicit_step;
  return c;
}

TEST(StressWeights, are_of_second_order_and_damp_most) {
  for (const double previous : {0.1, 0.7, 1.0, 3.0}) {
    const double dt = 0.7;
    const StressWeights w = stress_weights(dt, previous);
    EXPECT_NEAR(w.coming + w.now + w.before, 1.0, 1e-15);
    // a slope that grows linearly from the middle of the step
    EXPECT_NEAR(0.5 * dt * (w.coming - w.now) - (0.5 * dt + previous) * w.before, 0.0, 1e-15);
    EXPECT_NEAR(w.now * w.now, 4.0 * w.coming * w.before, 1e-15);
  }
  EXPECT_NEAR(stress_weights(1.0, 1.0).coming, 9.0 / 16.0, 1e-15);
  EXPECT_EQ(stress_weights(1.0, 0.0).coming, 1.0);
}

TEST(ImplicitViscosity, leaves_the_step_to_convection) {
  const GasCase c = implicit(box_case(Vec3(1, 1, 1), {8, 8, 8}));
  EXPECT_TRUE(std::isinf(GasSolver(c, MPI_COMM_WORLD).step_limits().viscosity));
}

constexpr double beyond_the_limit = 20.0;

// Steps of 20 times the explicit limit.
double long_step(const GasCase& c) {
  GasCase explicit_case = c;
  explicit_case.numerics.viscosity = Viscosity::explicit_step;
  return beyond_the_limit * GasSolver(explicit_case, MPI_COMM_WORLD).step_limits().viscosity;
}

TEST(ImplicitViscosity, gives_couette_flow_exactly) {
  GasCase c = implicit(box_case(Vec3(1, 1, 1), {2, 1, 8}));
  set_sides(c, 0, BoundaryType::periodic);
  set_sides(c, 1, BoundaryType::slip);
  c.boundaries[2][1].wall_velocity = Vec3(1, 0, 0);
  GasSolver solver(c, MPI_COMM_WORLD);
  for (int n = 0; n < 100; ++n) solver.advance(long_step(c));
  for_each_cell(solver.pressure().size(), [&](int i, int j, int k) {
    const double z = testing::cell_centre(solver.decomposition(), i, j, k)[2];
    EXPECT_NEAR(solver.velocity()[0](i, j, k), z, 1e-8);
  });
}

// Gas pressed by an inlet through a channel with a ball, which stands off the grid lines.
GasCase creeping_channel() {
  GasCase c = box_case(Vec3(1, 1, 1.5), {8, 8, 12});
  c.boundaries[2][0] = testing::inlet(Vec3(0, 0, 0.5));
  c.boundaries[2][1] = side(BoundaryType::outlet);
  c.bodies = bodies("[[body]]\nname='ball'\nsphere={center=[0.52,0.47,0.6],radius=0.23}\n");
  return c;
}

// Largest difference of the velocities of two solvers on the same blocks.
double difference(const GasSolver& a, const GasSolver& b) {
  double largest = 0.0;
  for (int d = 0; d < 3; ++d) {
    for_each_face(a.decomposition(), d, [&](int i, int j, int k) {
      largest = std::max(largest, std::abs(a.velocity()[d](i, j, k) - b.velocity()[d](i, j, k)));
    });
  }
  return max_over_ranks(a.decomposition(), largest);
}

TEST(ImplicitViscosity, has_steady_flows_that_do_not_depend_on_the_step) {
  const GasCase c = implicit(creeping_channel());
  const double dt = long_step(c);
  GasSolver coarse(c, MPI_COMM_WORLD), fine(c, MPI_COMM_WORLD);
  for (int n = 0; n < 200; ++n) coarse.advance(dt);
  for (int n = 0; n < 400; ++n) fine.advance(dt / 4.0);
  EXPECT_LT(difference(coarse, fine), 1e-5);
}

TEST(ImplicitViscosity, has_the_steady_flow_of_explicit_viscosity) {
  GasCase c = box_case(Vec3(1, 1, 1), {4, 1, 8});
  c.gas.gravity = Vec3(1, 0, 0);
  set_sides(c, 0, BoundaryType::periodic);
  set_sides(c, 1, BoundaryType::slip);
  c.bodies = bodies("[[body]]\nname='floor'\nplane={point=[0,0,0.2],normal=[0,0,1]}\n");
  GasSolver explicit_solver(c, MPI_COMM_WORLD), solver(implicit(c), MPI_COMM_WORLD);
  const double dt = long_step(c);
  for (int n = 0; n < 100; ++n) solver.advance(dt);
  for (int n = 0; n < 100 * beyond_the_limit; ++n) explicit_solver.advance(dt / beyond_the_limit);
  EXPECT_LT(difference(solver, explicit_solver), 1e-7);
}

TEST(ImplicitViscosity, closes_the_momentum_budget_and_the_loads) {
  GasCase c = implicit(creeping_channel());
  c.gas.gravity = Vec3(0.1, 0, -1);
  GasSolver solver(c, MPI_COMM_WORLD);
  testing::set_moving_heap(solver, 0.0, 0.3, 40.0);
  solver.accept_void_fraction_as_old();
  for (int n = 1; n <= 4; ++n) {
    testing::set_moving_heap(solver, 0.05 * n, 0.3, 40.0);
    const double dt = 0.01 * (1.0 + 0.3 * (n % 2));
    const MomentumBudget m = solver.advance(dt).momentum;
    const double scale = testing::turnover(m);
    EXPECT_GT(m.body.norm(), 1e-3 * scale);
    EXPECT_LT(testing::imbalance(m).norm(), 1e-12 * scale);
    EXPECT_LT(testing::pressure_imbalance(m).norm(), 1e-12 * scale);
    EXPECT_LT((dt * solver.body_loads().at(0).friction + m.body + m.body_stress).norm(),
              1e-12 * scale);
  }
}

// A ball that is pulled through viscous gas in a box with an outlet.
GasCase pulled_ball() {
  GasCase c = box_case(Vec3(1, 1, 1.5), {10, 10, 15});
  c.boundaries[2][1] = side(BoundaryType::outlet);
  c.gas.viscosity = 0.1;
  c.numerics.pressure_tolerance = 1e-10;
  c.bodies = bodies(
      "[[body]]\nname='ball'\nsphere={center=[0.52,0.47,0.5],radius=0.23}\n"
      "motion={translate={velocity=[0,0,0.5]}}\n");
  return c;
}

// Its flow after 0.4 s, in equal steps of about `dt` s.
VectorField flow_behind_ball(const GasCase& c, double dt) {
  GasSolver solver(c, MPI_COMM_WORLD);
  const int steps = static_cast<int>(std::ceil(0.4 / dt));
  for (int n = 0; n < steps; ++n) {
    const StepReport report = solver.advance(0.4 / steps);
    const double scale = testing::turnover(report.momentum);
    EXPECT_LT(testing::imbalance(report.momentum).norm(), 1e-11 * scale) << n;
    EXPECT_LT(testing::pressure_imbalance(report.momentum).norm(), 1e-11 * scale) << n;
    EXPECT_LT(report.divergence, 1e-8) << n;
  }
  return solver.velocity();
}

// Faces that a body gives free make the flow depend on the step: 4 % at the explicit limit.
TEST(ImplicitViscosity, is_around_a_moving_body_as_near_to_short_steps_as_explicit_viscosity) {
  const GasCase c = pulled_ball();
  const double limit = GasSolver(c, MPI_COMM_WORLD).step_limits().viscosity;
  const VectorField exact = flow_behind_ball(c, 0.2 * limit);
  const double by_explicit = testing::distance(flow_behind_ball(c, limit), exact);
  const double by_implicit = testing::distance(flow_behind_ball(implicit(c), 10.0 * limit), exact);
  EXPECT_LT(by_implicit, 2.0 * by_explicit) << by_explicit;
}

// Kinetic energy after some long steps, the same on any number of ranks.
double energy(MPI_Comm communicator) {
  GasCase c = implicit(creeping_channel());
  c.numerics.pressure_tolerance = 1e-12;
  GasSolver solver(c, communicator);
  for (int n = 0; n < 5; ++n) solver.advance(0.02);
  double sum = 0.0;
  for (int d = 0; d < 3; ++d) {
    for_each_cell(solver.pressure().size(), [&](int i, int j, int k) {
      sum += solver.velocity()[d](i, j, k) * solver.velocity()[d](i, j, k);
    });
  }
  return sum_over_ranks(solver.decomposition(), sum);
}

TEST(ImplicitViscosity, does_not_depend_on_the_decomposition) {
  const double alone = energy(MPI_COMM_SELF);
  EXPECT_NEAR(energy(MPI_COMM_WORLD), alone, 1e-7 * alone);
}

VectorField vortices(Viscosity viscosity, int steps) {
  return testing::drifting_vortices(steps, [&](GasCase& c) {
    c.gas.viscosity = 0.1;
    c.numerics.viscosity = viscosity;
  });
}

TEST(ImplicitViscosity, is_of_second_order_in_time) {
  const VectorField exact = vortices(Viscosity::explicit_step, 800);
  const double coarse = testing::distance(vortices(Viscosity::implicit_step, 16), exact);
  const double fine = testing::distance(vortices(Viscosity::implicit_step, 32), exact);
  const double finest = testing::distance(vortices(Viscosity::implicit_step, 64), exact);
  EXPECT_GT(std::log2(coarse / fine), 1.8) << coarse << " " << fine;
  EXPECT_GT(std::log2(fine / finest), 1.8) << fine << " " << finest;
}

}  // namespace
}  // namespace gasgrain::cfd
