#include "coupling/energy_audit.hpp"

#include <gtest/gtest.h>

namespace gasgrain::coupling {
namespace {

const Vec3 gravity(0, 0, -10);

GrainTotals grain(double height, double speed) {
  return {.count = 1,
          .mass = 2,
          .momentum = Vec3(0, 0, -2 * speed),
          .mass_moment = Vec3(0, 0, 2 * height),
          .kinetic_energy = speed * speed,
          .rotation_energy = 0,
          .elastic_energy = 0};
}

TEST(EnergyAudit, free_fall_dissipates_nothing) {
  EnergyAudit audit;
  audit.begin(grain(5, 0));
  const EnergyBalance balance = audit.close(grain(0, 10), {}, gravity, MPI_COMM_SELF);
  EXPECT_NEAR(balance.dissipated, 0.0, 1e-12);
}

TEST(EnergyAudit, what_gas_gave_and_nobody_has_is_dissipated) {
  EnergyAudit audit;
  audit.begin(grain(0, 3));
  audit.add_gas_work(4.0);
  GrainTotals now = grain(0, 3);
  now.elastic_energy = 1.5;
  EXPECT_NEAR(audit.close(now, {}, gravity, MPI_COMM_SELF).dissipated, 2.5, 1e-12);
  EXPECT_NEAR(audit.close(now, {}, gravity, MPI_COMM_SELF).dissipated, 0.0, 1e-12);
}

TEST(EnergyAudit, a_grain_that_leaves_takes_its_energy_along) {
  EnergyAudit audit;
  audit.begin(grain(5, 0));
  TrafficSums traffic{.left = 1, .mass = -2, .mass_moment = Vec3(0, 0, -2), .energy = -80};
  EXPECT_NEAR(audit.close({}, traffic, gravity, MPI_COMM_SELF).dissipated, 0.0, 1e-12);
}

TEST(GrainTraffic, counts_the_halves_of_a_step) {
  GrainTraffic traffic;
  const GrainPassage passage{3.0, Vec3(0, 0, 1), Vec3(0, 0, 2), 6.0, 0.25};
  traffic.left(passage, Vec3(0, 0, 8), GrainTraffic::Moment::mid_step);
  traffic.force_applied(0.5);  // it had the first half of this step
  traffic.force_applied(0.5);
  traffic.exchanged();
  traffic.force_applied(0.5);  // the first half of this one comes from the old forces
  traffic.force_applied(0.5);
  const TrafficSums sums = traffic.take(MPI_COMM_SELF);
  EXPECT_EQ(sums.left, 1);
  EXPECT_DOUBLE_EQ(sums.mass, -3);
  EXPECT_DOUBLE_EQ(sums.mass_time, -0.75);
  EXPECT_DOUBLE_EQ(sums.momentum[2], -6);
  EXPECT_DOUBLE_EQ(sums.undelivered[2], 8 * (0.25 + 0.5 + 0.25));
  EXPECT_EQ(traffic.take(MPI_COMM_SELF).left, 0);
}

}  // namespace
}  // namespace gasgrain::coupling
