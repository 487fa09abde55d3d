// Velocity Verlet gives half of a step's force before the grains move and half after. A grain that
// leaves in between has its first half; one that appears gets the second. From then on the sum of
// held forces, by which the audit counts what the grains receive, includes a grain that is no
// longer there until the next exchange.
#include "coupling/grain_traffic.hpp"

#include <array>
#include <cmath>
#include <utility>

namespace gasgrain::coupling {

namespace {

constexpr std::size_t value_count = 14;

std::array<double, value_count> values_of(const TrafficSums& s) {
  return {double(s.appeared), double(s.left),   s.mass,           s.mass_time,
          s.energy,           s.momentum[0],    s.momentum[1],    s.momentum[2],
          s.mass_moment[0],   s.mass_moment[1], s.mass_moment[2], s.undelivered[0],
          s.undelivered[1],   s.undelivered[2]};
}

TrafficSums sums_of(const std::array<double, value_count>& v) {
  return {.appeared = std::lround(v[0]),
          .left = std::lround(v[1]),
          .mass = v[2],
          .mass_time = v[3],
          .momentum = {v[5], v[6], v[7]},
          .mass_moment = {v[8], v[9], v[10]},
          .energy = v[4],
          .undelivered = {v[11], v[12], v[13]}};
}

void add(TrafficSums& sums, const GrainPassage& grain, double sign) {
  sums.mass += sign * grain.mass;
  sums.mass_time += sign * grain.mass * grain.time;
  sums.momentum += sign * grain.mass * grain.velocity;
  sums.mass_moment += sign * grain.mass * grain.position;
  sums.energy += sign * grain.energy;
}

}  // namespace

void GrainTraffic::appeared(const GrainPassage& grain) {
  ++sums_.appeared;
  add(sums_, grain, 1.0);
}

void GrainTraffic::left(const GrainPassage& grain, const Vec3& held, Moment moment) {
  ++sums_.left;
  add(sums_, grain, -1.0);
  held_ += held;
  if (moment == Moment::between_steps) applied_ += held;
}

void GrainTraffic::force_applied(double dem_step) {
  sums_.undelivered += 0.5 * dem_step * (applied_ + held_);
  applied_ = held_;
}

TrafficSums GrainTraffic::take(MPI_Comm communicator) {
  std::array<double, value_count> values = values_of(std::exchange(sums_, {}));
  MPI_Allreduce(MPI_IN_PLACE, values.data(), value_count, MPI_DOUBLE, MPI_SUM, communicator);
  return sums_of(values);
}

void GrainTraffic::visit_state(cfd::StateArchive& archive) {
  std::array<double, value_count> values = values_of(sums_);
  archive.partial_sums("traffic", values);
  archive.partial_sums("held_of_grains_that_left", {held_.data(), 3});
  archive.partial_sums("applied_of_grains_that_left", {applied_.data(), 3});
  if (archive.restores()) sums_ = sums_of(values);
}

}  // namespace gasgrain::coupling
