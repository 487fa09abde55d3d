#include "coupling/momentum_audit.hpp"

#include <gtest/gtest.h>

namespace gasgrain::coupling {
namespace {

const Vec3 gravity(0, 0, -10);

// A grain of 2 kg that falls for 3 s without gas and walls.
TEST(MomentumAudit, closes_for_free_fall) {
  MomentumAudit audit;
  audit.begin({.count = 1, .mass = 2}, Feedback::two_way);
  ExchangeReport report;
  report.interval = 3;
  audit.add_exchange(report);
  const MomentumBalance balance =
      audit.close({.count = 1, .mass = 2, .momentum = Vec3(0, 0, -60)}, {}, Vec3::Zero(), gravity);
  EXPECT_NEAR(balance.residual.norm(), 0.0, 1e-12);
  EXPECT_DOUBLE_EQ(balance.grain_weight[2], -60);
}

TEST(MomentumAudit, shows_a_missing_wall_force) {
  MomentumAudit audit;
  audit.begin({.count = 1, .mass = 2}, Feedback::two_way);
  ExchangeReport report;
  report.interval = 3;
  audit.add_exchange(report);
  const MomentumBalance balance = audit.close({.count = 1, .mass = 2}, {}, Vec3(0, 0, 55), gravity);
  EXPECT_NEAR(balance.residual[2], 5.0, 1e-12);  // 60 N s of weight, 55 N s of wall
}

// Grains received 4 N s of the 5 N s that the gas gave: one is still on the way.
TEST(MomentumAudit, counts_impulse_in_transit) {
  MomentumAudit audit;
  audit.begin({.count = 1, .mass = 2}, Feedback::two_way);
  ExchangeReport report;
  report.interval = 1;
  report.force_on_grains = Vec3(5, 0, 0);
  report.gas_momentum.drag = Vec3(-5, 0, 0);
  report.gas_momentum.stored = Vec3(-5, 0, 0);
  audit.add_exchange(report);
  audit.add_received(Vec3(4, 0, 0));
  const MomentumBalance balance = audit.close({.count = 1, .mass = 2, .momentum = Vec3(4, 0, 0)},
                                              {}, Vec3::Zero(), Vec3::Zero());
  EXPECT_NEAR(balance.residual.norm(), 0.0, 1e-12);
  EXPECT_DOUBLE_EQ(balance.in_transit[0], -1);
}

TEST(MomentumAudit, starts_anew_after_closing) {
  MomentumAudit audit;
  audit.begin({.count = 1, .mass = 2}, Feedback::two_way);
  ExchangeReport report;
  report.interval = 3;
  audit.add_exchange(report);
  const GrainTotals fallen{.count = 1, .mass = 2, .momentum = Vec3(0, 0, -60)};
  audit.close(fallen, {}, Vec3::Zero(), gravity);
  EXPECT_EQ(audit.close(fallen, {}, Vec3::Zero(), gravity).residual.norm(), 0.0);
}

// One-way: what the gas does is no part of the balance.
TEST(MomentumAudit, balances_the_grains_alone_in_one_way_coupling) {
  MomentumAudit audit;
  audit.begin({.count = 1, .mass = 2}, Feedback::one_way);
  ExchangeReport report;
  report.interval = 1;
  report.gas_momentum.stored = Vec3(100, 0, 0);
  audit.add_exchange(report);
  audit.add_received(Vec3(4, 0, 0));
  const MomentumBalance balance = audit.close({.count = 1, .mass = 2, .momentum = Vec3(4, 0, 0)},
                                              {}, Vec3::Zero(), Vec3::Zero());
  EXPECT_NEAR(balance.residual.norm(), 0.0, 1e-12);
}

}  // namespace
}  // namespace gasgrain::coupling
