#include "liggghts_plugins/sdf_wall.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace gasgrain::plugins {

namespace {

// Below this length of grad(phi) there is no wall normal (points equally far from several
// surfaces).
constexpr double smallest_gradient = 1e-3;

// By how much an interpolated field may exceed the distance where it has a kink, in radii of the
// grain: 0.05 spacings of a quarter of the radius. So far out several contacts are looked for.
constexpr double excess_at_kinks = 0.0125;

bool has_normal(const DistanceSample& wall) {
  return wall.gradient.squaredNorm() > smallest_gradient * smallest_gradient;
}

}  // namespace

void SdfWall::set_time(double time, double duration) {
  time_ = time;
  torque_point_ = torque_point_at(body_, time);
  if (body_.motion.is_at_rest()) return;
  pose_ = body_.motion.pose(time);
  turn_ = pose_.rotation * body_.motion.pose(time - duration).rotation.transpose();
}

void SdfWall::carry(const Carriage& carriage) {
  carried_ = true;
  pose_.translation = carriage.displacement;
  torque_point_ = body_.torque_point + carriage.displacement;
  carried_velocity_ = body_.surface_velocity + carriage.velocity;
  carried_sweep_ = carriage.sweep;
}

DistanceSample SdfWall::sample(const Vec3& x) const {
  if (!sweeps()) return body_.shape->sample(x);
  const DistanceSample at_rest = body_.shape->sample(pose_.to_body(x));
  return {at_rest.distance, pose_.rotation * at_rest.gradient};
}

double SdfWall::distance(const Vec3& x) const {
  return body_.shape->distance(sweeps() ? pose_.to_body(x) : x);
}

Vec3 SdfWall::velocity_at(const Vec3& x) const {
  if (carried_) return carried_velocity_;
  return body_.motion.is_at_rest() ? body_.surface_velocity : surface_velocity_at(body_, x, time_);
}

double SdfWall::fastest_sweep(const Vec3& lower, const Vec3& upper) const {
  const Motion& motion = body_.motion;
  if (carried_) return carried_sweep_;
  if (!motion.sweeps()) return 0.0;
  const Vec3 centre = pose_.to_world(motion.centre);
  const double arm = (lower - centre).cwiseAbs().cwiseMax((upper - centre).cwiseAbs()).norm();
  const double swing = motion.amplitude.norm() * 2.0 * std::numbers::pi / motion.period;
  return motion.velocity.norm() + swing + std::abs(motion.rate) * arm;
}

NearSurfaces SdfWall::contacts_of(const GrainAtWall& grain, const DistanceSample& nearest) const {
  if (!sweeps()) return ball_contacts(*body_.shape, nearest, grain.position, grain.radius);
  const Mat3& rotation = pose_.rotation;
  NearSurfaces walls =
      ball_contacts(*body_.shape, {nearest.distance, rotation.transpose() * nearest.gradient},
                    pose_.to_body(grain.position), grain.radius);
  for (int n = 0; n < walls.count; ++n)
    walls.surface[n].gradient = rotation * walls.surface[n].gradient;
  return walls;
}

template <TangentialModel tangential>
WallTouch SdfWall::touch(const GrainAtWall& grain, Vec3& displacement, const TangentialStep& step,
                         WallLoad& load) {
  WallTouch result;
  const DistanceSample nearest = sample(grain.position);
  const bool several = body_.shape->has_several_contacts();
  result.gap = nearest.distance - grain.radius - (several ? excess_at_kinks * grain.radius : 0.0);
  if (result.gap >= 0 || !(several || has_normal(nearest))) {
    displacement.setZero();
    forget(grain.tag);
    return result;
  }
  result.touches = true;
  if (!several) {
    add_contact<tangential>(grain, nearest, displacement, step, result, load);
    return result;
  }
  const NearSurfaces walls = contacts_of(grain, nearest);
  if (walls.count > 1 || edge_springs(grain.tag)) {
    touch_edge<tangential>(grain, walls, displacement, step, result, load);
  } else if (walls.count == 1 && has_normal(walls.surface[0])) {
    add_contact<tangential>(grain, walls.surface[0], displacement, step, result, load);
  } else {
    displacement.setZero();
  }
  return result;
}

// Springs of the last step go to the contacts with the nearest normals.
template <TangentialModel tangential>
void SdfWall::touch_edge(const GrainAtWall& grain, const NearSurfaces& walls, Vec3& displacement,
                         const TangentialStep& step, WallTouch& touch, WallLoad& load) {
  std::vector<EdgeSpring> before;
  if (const auto* known = edge_springs(grain.tag))
    before = *known;
  else if (walls.count > 0)
    before.push_back({walls.surface[0].gradient.normalized(), displacement});
  std::vector<EdgeSpring> now;
  for (int w = 0; w < walls.count; ++w) {
    if (!has_normal(walls.surface[w])) continue;
    now.push_back({walls.surface[w].gradient.normalized(), Vec3::Zero()});
    for (const EdgeSpring& old : before)
      if ((turn_ * old.normal).dot(now.back().normal) > same_normal)
        now.back().displacement = old.displacement;
    add_contact<tangential>(grain, walls.surface[w], now.back().displacement, step, touch, load);
  }
  displacement = now.size() == 1 ? now[0].displacement : Vec3(Vec3::Zero());
  if (now.size() > 1)
    edge_springs_[grain.tag] = std::move(now);
  else
    forget(grain.tag);
}

template <TangentialModel tangential>
void SdfWall::add_contact(const GrainAtWall& grain, const DistanceSample& wall, Vec3& displacement,
                          const TangentialStep& step, WallTouch& touch, WallLoad& load) const {
  const double overlap = grain.radius - wall.distance;
  const double gradient = wall.gradient.norm();
  const Vec3 n = wall.gradient / gradient;
  const double lever = grain.radius - 0.5 * overlap;
  const Vec3 point = grain.position - lever * n;
  if (body_.motion.rate != 0.0 && step.history == History::advance)
    displacement = turn_ * displacement;
  const ContactState state{.n = n,
                           .overlap = gradient * overlap,
                           .relative_velocity = grain.velocity - velocity_at(point),
                           .lever_spin = lever * grain.spin};
  const GrainContact& contact = contacts_(grain.type, wall_type_);
  const ContactCoefficients c = contact.first_against_fixed(grain.mass);
  ContactForce f = contact_force<tangential>(c, state, displacement, step);
  if (contact.has_surface_forces()) {
    const RollingPair rolling{.relative_spin = grain.spin - body_.motion.angular_velocity(time_),
                              .effective_radius = grain.radius,
                              .inertia = sphere_inertia(grain.mass, grain.radius)};
    const Vec3 torque =
        add_surface_forces(contact.surface_of_first_against_fixed({grain.mass, grain.radius}), n,
                           rolling, step.duration, f);
    touch.torque += torque;
    load.torque -= torque;
  }
  touch.force += f.force;
  touch.torque += lever * f.moment;
  load.force -= f.force;
  load.torque -= (point - torque_point_).cross(f.force);
  load.contacts += 1;
  load.largest.length = std::max(load.largest.length, overlap);
  load.largest.relative = std::max(load.largest.relative, overlap / (2.0 * grain.radius));
}

const std::vector<EdgeSpring>* SdfWall::edge_springs(int tag) const {
  if (edge_springs_.empty()) return nullptr;
  const auto found = edge_springs_.find(tag);
  return found == edge_springs_.end() ? nullptr : &found->second;
}

void SdfWall::set_edge_springs(int tag, std::vector<EdgeSpring> springs) {
  if (springs.empty())
    forget(tag);
  else
    edge_springs_[tag] = std::move(springs);
}

template WallTouch SdfWall::touch<TangentialModel::off>(const GrainAtWall&, Vec3&,
                                                        const TangentialStep&, WallLoad&);
template WallTouch SdfWall::touch<TangentialModel::no_history>(const GrainAtWall&, Vec3&,
                                                               const TangentialStep&, WallLoad&);
template WallTouch SdfWall::touch<TangentialModel::history>(const GrainAtWall&, Vec3&,
                                                            const TangentialStep&, WallLoad&);

}  // namespace gasgrain::plugins
