#include "coupling/shared/motion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace gasgrain {

namespace {

constexpr double full_turn = 2.0 * std::numbers::pi;

class MovedShape final : public SignedDistance {
 public:
  MovedShape(Shape at_rest, const Pose& pose) : at_rest_(std::move(at_rest)), pose_(pose) {}
  double distance(const Vec3& x) const override { return at_rest_->distance(pose_.to_body(x)); }
  DistanceSample sample(const Vec3& x) const override {
    const DistanceSample found = at_rest_->sample(pose_.to_body(x));
    return {found.distance, pose_.rotation * found.gradient};
  }
  double resolved_range() const override { return at_rest_->resolved_range(); }

 private:
  Shape at_rest_;
  Pose pose_;
};

void read_rotation(Motion& motion, const ConfigTable& table) {
  motion.centre = table.vector("point");
  const Vec3 axis = table.vector("axis");
  if (axis.norm() == 0.0) table.fail("axis", "must not be zero: it gives a direction");
  motion.axis = axis.normalized();
  motion.rate = table.number("rate");
  table.reject_unknown_keys();
}

void read_oscillation(Motion& motion, const ConfigTable& table) {
  motion.amplitude = table.vector("amplitude");
  if (table.has("frequency")) {
    if (table.has("period")) table.fail("frequency", "is given beside `period`; give one of them");
    motion.period = 1.0 / table.number("frequency", Range::positive());
  } else {
    motion.period = table.number("period", Range::positive());
  }
  motion.phase = table.number_or("phase", 0.0);
  table.reject_unknown_keys();
}

}  // namespace

Mat3 rotation_about(const Vec3& axis, double angle) {
  return Eigen::AngleAxisd(angle, axis).toRotationMatrix();
}

Vec3 Motion::displacement(double time) const {
  const double tau = std::max(0.0, std::min(time, stop) - start);
  return velocity * tau +
         amplitude * (std::sin(full_turn * tau / period + phase) - std::sin(phase));
}

Pose Motion::pose(double time) const {
  if (!sweeps()) return {};
  const double tau = std::max(0.0, std::min(time, stop) - start);
  Pose pose;
  pose.translation = displacement(time);
  if (rate != 0.0) {
    pose.rotation = rotation_about(axis, rate * tau);
    pose.translation += centre - pose.rotation * centre;
  }
  return pose;
}

Vec3 Motion::translation_velocity(double time) const {
  if (time < start || time >= stop) return Vec3::Zero();
  const double frequency = full_turn / period;
  return velocity + amplitude * (frequency * std::cos(frequency * (time - start) + phase));
}

Vec3 Motion::angular_velocity(double time) const {
  return time < start || time >= stop ? Vec3(Vec3::Zero()) : Vec3(rate * axis);
}

Vec3 Motion::velocity_at(const Vec3& x, double time) const {
  if (is_at_rest()) return Vec3::Zero();
  const Vec3 travelled = surface_only ? Vec3(Vec3::Zero()) : displacement(time);
  return translation_velocity(time) + angular_velocity(time).cross(x - centre - travelled);
}

Motion read_motion(const ConfigTable& table) {
  for (const char* key : {"translate", "oscillate", "rotate", "start", "stop", "surface_only"}) {
    table.has(key);
  }
  table.reject_unknown_keys();
  Motion motion;
  if (table.has("translate")) {
    const ConfigTable translate = table.table("translate");
    motion.velocity = translate.vector("velocity");
    translate.reject_unknown_keys();
  }
  if (table.has("oscillate")) read_oscillation(motion, table.table("oscillate"));
  if (table.has("rotate")) read_rotation(motion, table.table("rotate"));
  if (!table.has("translate") && !table.has("oscillate") && !table.has("rotate")) {
    table.fail("rotate",
               "is missing, and so are translate and oscillate; give at least one, or "
               "leave `motion` out");
  }
  motion.start = table.number_or("start", motion.start);
  motion.stop = table.number_or("stop", motion.stop, {.lower = motion.start});
  motion.surface_only = table.flag_or("surface_only", false);
  return motion;
}

Shape move_shape(Shape at_rest, const Pose& pose) {
  return std::make_shared<const MovedShape>(std::move(at_rest), pose);
}

}  // namespace gasgrain
