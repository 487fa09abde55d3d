// Momentum balance of gas and grains together over an interval, from independently measured parts.
#pragma once

#include "cfd/state_archive.hpp"
#include "coupling/coupling_options.hpp"
#include "coupling/exchange_report.hpp"
#include "coupling/grain_totals.hpp"
#include "coupling/grain_traffic.hpp"

namespace gasgrain::coupling {

// Impulses in N s over the interval. Gas and grains are one system; the change of its momentum must
// equal what acts on it from outside, up to round-off and the tolerance of the pressure solve.
struct MomentumBalance {
  double interval = 0.0;              // s
  Vec3 grain_change = Vec3::Zero();   // change of the grains' momentum
  Vec3 gas_change = Vec3::Zero();     // change of the gas's momentum
  Vec3 side_pressure = Vec3::Zero();  // pressure on the sides of the grid
  Vec3 grain_weight = Vec3::Zero();
  Vec3 gas_weight = Vec3::Zero();
  Vec3 walls_on_grains = Vec3::Zero();    // contact with walls
  Vec3 bodies_on_gas = Vec3::Zero();      // pressure and friction of immersed bodies
  Vec3 walls_by_drag = Vec3::Zero();      // drag in directions without a free face
  Vec3 gas_through_sides = Vec3::Zero();  // convection (with the remainder of the advective
                                          // form) and shear at the sides
  Vec3 in_transit = Vec3::Zero();         // gas force: received by the grains minus given by the
                                          // gas; grains receive an interval later
  Vec3 passage = Vec3::Zero();            // of grains that appeared, minus those that left
  Vec3 residual = Vec3::Zero();
  long unexplained_grains = 0;  // that appeared (left: negative) without notice
};

class MomentumAudit {
 public:
  // Starts the first interval. `feedback` one_way: the balance is that of the grains alone.
  void begin(const GrainTotals& grains, Feedback feedback);
  void add_exchange(const ExchangeReport& report);
  // Impulse of the gas force that the integrator applied to the grains, N s.
  void add_received(const Vec3& impulse) { received_ += impulse; }

  // The interval under way.
  void visit_state(cfd::StateArchive& archive);

  double interval() const { return interval_; }  // s since begin() or the last close()

  // Balance since begin() or the last close(), and starts the next interval. `walls` is the impulse
  // of walls on grains since then, `gravity` in m/s^2.
  MomentumBalance close(const GrainTotals& now, const TrafficSums& traffic, const Vec3& walls,
                        const Vec3& gravity);

 private:
  Feedback feedback_ = Feedback::two_way;
  GrainTotals last_;
  cfd::MomentumBudget gas_;
  Vec3 given_ = Vec3::Zero(), received_ = Vec3::Zero(), drag_on_walls_ = Vec3::Zero();
  double interval_ = 0.0;
};

}  // namespace gasgrain::coupling
