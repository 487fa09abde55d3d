// Bodies that move through the gas: conservation, known flows, regions that open and close.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "coupling/shared/error.hpp"
#include "tests/cfd/gas_fixture.hpp"
#include "tests/shared/error_checks.hpp"

namespace gasgrain::cfd {
namespace {

using testing::bodies;
using testing::box_case;
using testing::set_sides;
using testing::side;

// A sealed box with a ball that swings and a vane that turns.
GasCase sealed_box() {
  GasCase c = box_case(Vec3(1.0, 0.9, 1.1), {15, 14, 16});
  c.gas = {.density = 1.2, .viscosity = 0.01, .gravity = Vec3(0, 0, -9.81)};
  c.numerics.pressure_tolerance = 1e-13;
  c.bodies = bodies(
      "[[body]]\nname='shell'\ncomplement={cylinder={start=[0.5,0.45,0.03],end=[0.5,0.45,1.08],"
      "radius=0.46}}\n"
      "[[body]]\nname='ball'\nsphere={center=[0.5,0.42,0.8],radius=0.14}\n"
      "motion={oscillate={amplitude=[0.1,0.05,0.02],period=0.5}}\n"
      "[[body]]\nname='vane'\nbox={lower=[0.2,0.37,0.15],upper=[0.7,0.53,0.45]}\n"
      "motion={rotate={point=[0.5,0.45,0],axis=[0,0,1],rate=3},start=0.004}\n");
  return c;
}

TEST(MovingBody, in_a_sealed_vessel_keeps_the_gas_continuous_to_round_off) {
  GasSolver solver(sealed_box(), MPI_COMM_WORLD);
  for (int n = 0; n < 25; ++n) {
    const StepReport report = solver.advance(2e-3);
    EXPECT_LT(report.divergence, 1e-12) << n;
    EXPECT_LT(report.removed_mean, 1e-12) << n;
    EXPECT_LT(report.swept_imbalance, 1e-12) << n;
    EXPECT_LT(report.largest_speed, 10.0) << n;
    EXPECT_LT(testing::imbalance(report.momentum).norm(),
              1e-11 * testing::turnover(report.momentum));
    EXPECT_LT(testing::pressure_imbalance(report.momentum).norm(),
              1e-11 * testing::turnover(report.momentum));
  }
}

// Seen from a moving train nothing happens: gas and body travel together through a periodic box.
TEST(MovingBody, that_travels_with_the_gas_disturbs_nothing) {
  struct Fluid {
    double viscosity;
    Viscosity method;
    double round_off;
  };
  for (const auto& [viscosity, method, round_off] :
       {Fluid{0.0, Viscosity::explicit_step, 1e-12}, Fluid{0.05, Viscosity::explicit_step, 1e-12},
        Fluid{0.5, Viscosity::implicit_step, 1e-8}}) {
    GasCase c = box_case(Vec3(1, 1, 1), {12, 12, 12});
    for (int d = 0; d < 3; ++d) set_sides(c, d, BoundaryType::periodic);
    c.gas.viscosity = viscosity;
    c.numerics.viscosity = method;
    c.numerics.pressure_tolerance = 1e-12;
    const Vec3 wind(1.0, -0.6, 0.3);
    c.initial.velocity = wind;
    c.bodies = bodies(
        "[[body]]\nname='ball'\nsphere={center=[0.35,0.6,0.45],radius=0.22}\n"
        "motion={translate={velocity=[1,-0.6,0.3]}}\n");
    GasSolver solver(c, MPI_COMM_WORLD);
    for (int n = 0; n < 15; ++n) {
      const StepReport report = solver.advance(0.01);
      double largest = 0.0;
      for (int d = 0; d < 3; ++d) {
        for_each_cell(solver.pressure().size(), [&](int i, int j, int k) {
          largest = std::max(largest, std::abs(solver.velocity()[d](i, j, k) - wind[d]));
        });
      }
      EXPECT_LT(max_over_ranks(solver.decomposition(), largest), round_off) << n;
      EXPECT_LT(report.divergence, round_off) << n;
    }
  }
}

TEST(MovingBody, piston_pushes_out_its_own_volume) {
  GasCase c = box_case(Vec3(0.4, 0.4, 1), {4, 4, 20});
  c.gas.viscosity = 0.0;
  c.boundaries[2][1] = side(BoundaryType::outlet);
  c.bodies = bodies(
      "[[body]]\nname='piston'\nplane={point=[0,0,0.203],normal=[0,0,1]}\n"
      "motion={translate={velocity=[0,0,1]}}\n");
  GasSolver solver(c, MPI_COMM_WORLD);
  double largest_force = 0.0, first_force = 0.0;
  for (int n = 0; n < 60; ++n) {
    solver.advance(0.005);
    EXPECT_NEAR(solver.side_flux(2, 1), 0.16, 1e-10) << n;
    const double force = solver.body_loads()[0].pressure[2];
    if (n == 0) first_force = force;
    if (n > 0) largest_force = std::max(largest_force, std::abs(force));
  }
  // gas of 0.16 m^2 x 0.8 m set in motion in one step, and then no acceleration any more
  EXPECT_LT(first_force, -0.16 * 0.7 / 0.005);
  EXPECT_LT(largest_force, 0.5);
}

// A die below a vented shoe; the gate between them is drawn aside.
TEST(MovingBody, gate_joins_a_sealed_die_to_the_vented_shoe_when_it_opens) {
  GasCase c = box_case(Vec3(1.2, 0.3, 0.8), {24, 3, 16});
  c.gas = {.density = 1.0, .viscosity = 0.01, .gravity = Vec3(0, 0, -9.81)};
  c.numerics.pressure_tolerance = 1e-11;
  c.boundaries[2][1] = side(BoundaryType::outlet);
  c.boundaries[2][1].pressure = 50.0;
  c.bodies = bodies(
      "[[body]]\nname='table'\ndifference=[{box={lower=[-1,-1,-1],upper=[2,2,0.4]}},"
      "{box={lower=[0.1,-2,0.1],upper=[0.5,3,0.5]}}]\n"
      "[[body]]\nname='gate'\nbox={lower=[0.05,-1,0.31],upper=[0.56,2,0.49]}\n"
      "motion={translate={velocity=[2,0,0]},start=0.02}\n");
  GasSolver solver(c, MPI_COMM_WORLD);
  const auto pressure_in_die = [&] {
    std::vector<double> sums(2, 0.0);
    for_each_cell(solver.pressure().size(), [&](int i, int j, int k) {
      const Vec3 x = testing::cell_centre(solver.decomposition(), i, j, k);
      if (x[0] < 0.1 || x[0] > 0.5 || x[2] < 0.1 || x[2] > 0.25) return;
      sums[0] += solver.pressure()(i, j, k);
      sums[1] += 1.0;
    });
    sum_over_ranks(solver.decomposition(), sums);
    return sums[0] / sums[1];
  };
  double largest_imbalance = 0.0;
  while (solver.time() < 0.3) {
    const StepReport report = solver.advance(std::min(0.005, solver.largest_stable_step()));
    EXPECT_LT(report.removed_mean, 1e-12);
    EXPECT_LT(report.divergence, 1e-8);
    largest_imbalance = std::max(largest_imbalance, report.swept_imbalance);
    if (solver.time() < 0.02) {
      EXPECT_NEAR(pressure_in_die(), 0.0, 1.0);  // its own reference
    }
  }
  EXPECT_GT(pressure_in_die(), 40.0);
  EXPECT_LT(largest_imbalance, 1e-3);
}

TEST(MovingBody, that_compresses_a_sealed_vessel_is_a_user_error) {
  GasCase c = box_case(Vec3(0.4, 0.4, 1), {4, 4, 20});
  c.bodies = bodies(
      "[[body]]\nname='piston'\nplane={point=[0,0,0.203],normal=[0,0,1]}\n"
      "motion={translate={velocity=[0,0,1]}}\n");
  GasSolver solver(c, MPI_COMM_WORLD);
  expect_contains(user_error([&] { solver.advance(1e-3); }),
                  "has no outlet but would have to lose");
}

}  // namespace
}  // namespace gasgrain::cfd
