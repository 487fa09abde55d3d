// Gas:     d P_gas    = sides + bodies + weight + through sides - (p on grains) + drag
// Grains:  d P_grains = weight + walls + received + appeared - left
// Sum:     d P_gas + d P_grains = sides + weights + walls + bodies + through sides
//                                 - (drag on walls) + (received - given) + appeared - left
// with given = -drag - (drag on walls) + (p on grains), which the exchange makes equal to the sum
// of the grains' forces times the interval. Here it enters as that sum, so that an error of the
// exchange shows in the residual.
#include "coupling/momentum_audit.hpp"

#include <string>

namespace gasgrain::coupling {

void MomentumAudit::begin(const GrainTotals& grains, Feedback feedback) {
  *this = {};
  last_ = grains;
  feedback_ = feedback;
}

void MomentumAudit::add_exchange(const ExchangeReport& report) {
  add(gas_, report.gas_momentum);
  given_ += report.interval * report.force_on_grains + report.carried;
  drag_on_walls_ += report.drag_on_walls;
  interval_ += report.interval;
}

namespace {

void visit(cfd::StateArchive& archive, const std::string& name, Vec3& value) {
  for (int d = 0; d < 3; ++d) archive.number(name + "_" + "xyz"[d], value[d]);
}

}  // namespace

void MomentumAudit::visit_state(cfd::StateArchive& archive) {
  archive.number("audit_interval", interval_);
  visit(archive, "given", given_);
  visit(archive, "received", received_);
  visit(archive, "drag_on_walls", drag_on_walls_);
  coupling::visit_state(archive, "", last_);
  for (std::size_t n = 0; n < momentum_rows.size(); ++n)
    visit(archive, "gas_row_" + std::to_string(n), gas_.*momentum_rows[n]);
}

MomentumBalance MomentumAudit::close(const GrainTotals& now, const TrafficSums& traffic,
                                     const Vec3& walls, const Vec3& gravity) {
  MomentumBalance balance;
  balance.interval = interval_;
  balance.grain_change = now.momentum - last_.momentum;
  balance.grain_weight = ((last_.mass + traffic.mass) * interval_ - traffic.mass_time) * gravity;
  balance.passage = traffic.momentum;
  balance.unexplained_grains = now.count - last_.count - traffic.appeared + traffic.left;
  balance.walls_on_grains = walls;
  if (feedback_ == Feedback::two_way) {
    balance.gas_change = gas_.stored;
    balance.side_pressure = gas_.side_pressure;
    balance.gas_weight = gas_.gravity;
    balance.bodies_on_gas = gas_.body_pressure + gas_.body;
    balance.walls_by_drag = -drag_on_walls_;
    balance.gas_through_sides = gas_.convection + gas_.viscous;
    balance.in_transit = received_ - traffic.undelivered - given_;
  } else {
    balance.in_transit = received_ - traffic.undelivered;
  }
  balance.residual = balance.grain_change + balance.gas_change - balance.side_pressure -
                     balance.grain_weight - balance.gas_weight - balance.walls_on_grains -
                     balance.bodies_on_gas - balance.walls_by_drag - balance.gas_through_sides -
                     balance.in_transit - balance.passage;
  begin(now, feedback_);
  return balance;
}

}  // namespace gasgrain::coupling
