#include "coupling/run_audit.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace gasgrain::coupling {

RunAudit::RunAudit(const AuditBounds& bounds, Feedback feedback, bool drag_follows, DemHost& host,
                   MPI_Comm communicator)
    : bounds_(bounds),
      feedback_(feedback),
      drag_follows_(drag_follows),
      host_(host),
      communicator_(communicator) {}

GrainTotals RunAudit::begin(const ExchangeReport& first) {
  held_force_ = first.force_on_grains;
  const GrainTotals grains = host_.totals();
  momentum_.begin(grains, feedback_);
  energy_.begin(grains);
  host_.take_wall_impulse();
  host_.take_largest_overlap();
  return grains;
}

void RunAudit::set_up(const Vec3& force_sum) {
  applied_force_ = held_force_;
  applied_sum_ = force_sum;
}

// Velocity Verlet gives half of a step's force in that step and half in the next one.
void RunAudit::force_applied(double dem_step, const Vec3& force_sum) {
  if (drag_follows_) {
    received_sum_ += 0.5 * dem_step * (applied_sum_ + force_sum);
    applied_sum_ = force_sum;
  } else {
    momentum_.add_received(0.5 * dem_step * (applied_force_ + held_force_));
    applied_force_ = held_force_;
    traffic_.force_applied(dem_step);
  }
}

void RunAudit::note_gas_work(double elapsed) {
  energy_.add_gas_work(0.5 * elapsed * (gas_power_ + host_.gas_power()));
}

void RunAudit::exchanged(const ExchangeReport& report) {
  held_force_ = report.force_on_grains;
  momentum_.add_exchange(report);
  traffic_.exchanged();
}

void RunAudit::note_gas_power(std::span<const Vec3> forces,
                              const std::vector<GrainRecord>& grains) {
  gas_power_ = 0.0;
  std::size_t n = 0;
  for (const GrainRecord& grain : grains) gas_power_ += forces[n++].dot(grain.velocity);
}

// Since the last row.
double RunAudit::time_of_passage(double elapsed, GrainTraffic::Moment moment,
                                 double dem_step) const {
  const double half = moment == GrainTraffic::Moment::mid_step ? 0.5 * dem_step : 0.0;
  return momentum_.interval() + elapsed + half;
}

void RunAudit::grain_appeared(GrainPassage passage, double elapsed, GrainTraffic::Moment moment,
                              double dem_step) {
  passage.time = time_of_passage(elapsed, moment, dem_step);
  traffic_.appeared(passage);
}

void RunAudit::grain_left(GrainPassage passage, const Vec3& held, double elapsed,
                          GrainTraffic::Moment moment, double dem_step) {
  passage.time = time_of_passage(elapsed, moment, dem_step);
  // sums of forces that follow the grains know who is there
  traffic_.left(passage, drag_follows_ ? Vec3(Vec3::Zero()) : held, moment);
}

void RunAudit::collect_from_host() {
  wall_impulse_ += host_.take_wall_impulse();
  const plugins::LargestOverlap overlap = host_.take_largest_overlap();
  overlap_.length = std::max(overlap_.length, overlap.length);
  overlap_.relative = std::max(overlap_.relative, overlap.relative);
}

AuditRow RunAudit::close(int axis) {
  collect_from_host();
  Vec3 received = std::exchange(received_sum_, Vec3::Zero());
  MPI_Allreduce(MPI_IN_PLACE, received.data(), 3, MPI_DOUBLE, MPI_SUM, communicator_);
  momentum_.add_received(received);
  AuditRow row;
  row.grains = host_.totals();
  row.traffic = traffic_.take(communicator_);
  row.balance = momentum_.close(row.grains, row.traffic, wall_impulse_, host_.gravity());
  row.energy = energy_.close(row.grains, row.traffic, host_.gravity(), communicator_);
  wall_impulse_.setZero();
  const double weight = std::abs(row.balance.grain_weight[axis]);
  row.momentum_residual =
      weight > 0 ? row.balance.residual[axis] / weight : row.balance.residual[axis];
  // a bed at rest has next to no energy; what it would gain by sinking a diameter is its scale
  const double lift = row.grains.mass * host_.gravity().norm() * host_.sizes().largest_diameter;
  const double scale = row.energy.kinetic + row.energy.rotation + row.energy.elastic + lift;
  row.heating =
      scale > 0 && !host_.walls_move() ? std::max(0.0, -row.energy.dissipated) / scale : 0.0;
  row.overlap = std::exchange(overlap_, {});
  return row;
}

std::vector<AuditViolation> RunAudit::violations(const AuditRow& row,
                                                 const ExchangeReport& exchange, int axis) const {
  const bool has_weight = row.balance.grain_weight[axis] != 0.0;
  const AuditResiduals residuals{.momentum = has_weight ? row.momentum_residual : 0.0,
                                 .exchange = exchange.third_law_residual,
                                 .pressure_force = exchange.pressure_residual,
                                 .solid_volume = exchange.solid_volume_residual,
                                 .divergence = exchange.divergence,
                                 .heating = row.heating};
  return coupling::violations(bounds_, residuals,
                              {.unmeasured_walls = host_.unmeasured_walls(),
                               .unexplained_grains = row.balance.unexplained_grains});
}

void RunAudit::visit_state(cfd::StateArchive& archive) {
  momentum_.visit_state(archive);
  energy_.visit_state(archive);
  traffic_.visit_state(archive);
  archive.partial_sums("gas_power", {&gas_power_, 1});
  archive.partial_sums("received_sum", {received_sum_.data(), 3});
  for (int d = 0; d < 3; ++d) {
    const std::string axis(1, "xyz"[d]);
    archive.number("held_force_" + axis, held_force_[d]);
    archive.number("wall_impulse_" + axis, wall_impulse_[d]);
  }
  archive.number("overlap", overlap_.length);
  archive.number("relative_overlap", overlap_.relative);
}

}  // namespace gasgrain::coupling
