// What an exchange conserves, and that it does not depend on the ranks.
#include "coupling/gas_coupling.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "cfd/loops.hpp"
#include "coupling/mapping.hpp"
#include "tests/coupling/small_bed.hpp"
#include "tests/shared/error_checks.hpp"

namespace gasgrain::coupling {
namespace {

TEST(GasCoupling, obeys_newtons_third_law) {
  const CoupledCase given(bed);
  GasCoupling coupling(given.gas, given.options, MPI_COMM_WORLD);
  DealtGrains grains(bed_grains(), MPI_COMM_WORLD);
  coupling.begin(grains.forces, grains.mine());
  for (const double dt : {1e-5, 5e-5, 2e-5, 1e-4, 1e-4}) {
    move(grains.all(), dt);
    const ExchangeReport report = coupling.exchange(grains.forces, grains.mine(), dt);
    EXPECT_EQ(report.gas_steps, 1);
    EXPECT_LT(report.third_law_residual, 1e-12);
    EXPECT_LT(report.pressure_residual, 1e-12);
    EXPECT_LT(report.solid_volume_residual, 1e-12);
    EXPECT_GT(report.force_on_grains[2], 0.0);
  }
}

// Whatever spreads the grains, the gas loses what they get.
TEST(GasCoupling, conserves_volume_and_momentum_with_every_mapping) {
  for (const std::string& mapping : mapping_names()) {
    const CoupledCase given(bed + "[coupling]\nmapping = \"" + mapping + "\"\n");
    GasCoupling coupling(given.gas, given.options, MPI_COMM_WORLD);
    DealtGrains grains(bed_grains(), MPI_COMM_WORLD);
    coupling.begin(grains.forces, grains.mine());
    for (int n = 0; n < 3; ++n) {
      move(grains.all(), 1e-4);
      const ExchangeReport report = coupling.exchange(grains.forces, grains.mine(), 1e-4);
      EXPECT_LT(report.third_law_residual, 1e-12) << mapping;
      EXPECT_LT(report.pressure_residual, 1e-12) << mapping;
      EXPECT_LT(report.solid_volume_residual, 1e-12) << mapping;
    }
  }
}

// The tube swings through the grains of a closed vessel.
TEST(GasCoupling, conserves_volume_and_momentum_around_a_moving_body) {
  const std::string text = vessel + R"(
[[body]]
name = "plunger"
sphere = {center = [0.0052, 0.0026, 0.0142], radius = 0.0017}
motion = {oscillate = {amplitude = [0.001, 0, 0.002], period = 0.02}}
)";
  const CoupledCase given(text);
  GasCoupling coupling(given.gas, given.options, MPI_COMM_WORLD);
  DealtGrains grains(bed_grains(), MPI_COMM_WORLD);
  coupling.begin(grains.forces, grains.mine());
  int steps = 0;
  for (int n = 0; n < 12; ++n) {
    const double dt = n % 3 == 2 ? 1e-3 : 2e-4;
    move(grains.all(), dt);
    const ExchangeReport report = coupling.exchange(grains.forces, grains.mine(), dt);
    steps += report.gas_steps;
    EXPECT_LT(report.third_law_residual, 1e-12) << n;
    EXPECT_LT(report.pressure_residual, 1e-12) << n;
    EXPECT_LT(report.solid_volume_residual, 1e-12) << n;
    EXPECT_LT(report.removed_mean, 1e-12) << n;
    EXPECT_LT(report.divergence, 1e-12) << n;
  }
  EXPECT_GT(steps, 12);
}

// The forces that arrive at the grains add up to what the report says.
TEST(GasCoupling, reports_the_sum_of_the_forces) {
  const CoupledCase given(bed);
  GasCoupling coupling(given.gas, given.options, MPI_COMM_WORLD);
  DealtGrains grains(bed_grains(), MPI_COMM_WORLD);
  coupling.begin(grains.forces, grains.mine());
  const ExchangeReport report = coupling.exchange(grains.forces, grains.mine(), 1e-4);
  Vec3 sum = Vec3::Zero();
  for (const Vec3& force : grains.forces) sum += force;
  MPI_Allreduce(MPI_IN_PLACE, sum.data(), 3, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
  EXPECT_LT((sum - report.force_on_grains).norm(), 1e-12 * sum.norm());
}

// Every rank computes the whole by itself as well and compares.
TEST(GasCoupling, does_not_depend_on_the_ranks) {
  const CoupledCase given(bed);
  GasCoupling together(given.gas, given.options, MPI_COMM_WORLD);
  GasCoupling alone(given.gas, given.options, MPI_COMM_SELF);
  DealtGrains dealt(bed_grains(), MPI_COMM_WORLD), own(bed_grains(), MPI_COMM_SELF);
  together.begin(dealt.forces, dealt.mine());
  alone.begin(own.forces, own.mine());
  for (int step = 0; step < 5; ++step) {
    move(dealt.all(), 5e-5);
    move(own.all(), 5e-5);
    together.exchange(dealt.forces, dealt.mine(), 5e-5);
    alone.exchange(own.forces, own.mine(), 5e-5);
  }
  double largest_force = 0, force_error = 0, largest_pressure = 0, pressure_error = 0;
  for (std::size_t n = 0; n < own.all().size(); ++n) {
    largest_force = std::max(largest_force, own.forces[n].norm());
    if (const Vec3* force = dealt.force(n)) {
      force_error = std::max(force_error, (*force - own.forces[n]).norm());
    }
  }
  const cfd::Block& block = together.gas().decomposition().block();
  double void_error = 0;
  cfd::for_each_cell(block.size, [&](int i, int j, int k) {
    const cfd::Index3 at{i + block.lower[0], j + block.lower[1], k + block.lower[2]};
    const double p = alone.gas().pressure()(at[0], at[1], at[2]);
    largest_pressure = std::max(largest_pressure, std::abs(p));
    pressure_error = std::max(pressure_error, std::abs(together.gas().pressure()(i, j, k) - p));
    void_error = std::max(void_error, std::abs(together.gas().void_fraction()(i, j, k) -
                                               alone.gas().void_fraction()(at[0], at[1], at[2])));
  });
  EXPECT_LT(force_error, 1e-8 * largest_force);
  EXPECT_LT(pressure_error, 1e-8 * largest_pressure);
  EXPECT_LT(void_error, 1e-12);
}

TEST(GasCoupling, sealed_vessel_with_grains_crossing_cut_cells_stays_divergence_free) {
  const CoupledCase given(vessel);
  GasCoupling coupling(given.gas, given.options, MPI_COMM_WORLD);
  DealtGrains grains(bed_grains(), MPI_COMM_WORLD);
  ExchangeReport report = coupling.begin(grains.forces, grains.mine());
  for (int step = 0; step < 20; ++step) {
    move(grains.all(), 1e-4);
    report = coupling.exchange(grains.forces, grains.mine(), 1e-4);
    EXPECT_LT(report.divergence, 1e-12);
    EXPECT_LT(report.removed_mean, 1e-12);
    EXPECT_GE(report.smallest_void_fraction, 0.2);
    EXPECT_EQ(report.limited, 0);
  }
}

TEST(GasCoupling, refuses_a_void_fraction_that_is_not_positive) {
  const CoupledCase given(bed);
  GasCoupling coupling(given.gas, given.options, MPI_COMM_WORLD);
  const GrainKind kind{.ratio = 10};
  std::vector<GrainRecord> heap(300, kind.record(Vec3(0.002, 0.0025, 0.015), Vec3::Zero()));
  DealtGrains grains(heap, MPI_COMM_WORLD);
  expect_contains(user_error([&] { coupling.begin(grains.forces, grains.mine()); }),
                  "but must be positive");
}

}  // namespace
}  // namespace gasgrain::coupling
