#include "liggghts_plugins/sdf_wall.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "coupling/shared/near_surfaces.hpp"

namespace gasgrain::plugins {

namespace {

// Below this length of grad(phi) there is no wall normal (points equally far from several
// surfaces).
constexpr double smallest_gradient = 1e-3;

bool has_normal(const DistanceSample& wall) {
  return wall.gradient.squaredNorm() > smallest_gradient * smallest_gradient;
}

}  // namespace

SdfWall::SdfWall(Body body, int wall_type)
    : body_(std::move(body)),
      wall_type_(wall_type),
      several_(body_.shape->has_several_contacts()),
      steepest_(body_.shape->steepest_gradient()) {}

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

double SdfWall::distance(const Vec3& x) const {
  return body_.shape->distance(in_body(x));
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

// `way`: m, that the grain can go before it touches, when it does not.
SdfWall::Contacts SdfWall::find_contacts(const GrainAtWall& grain, LocalWalls& walls,
                                         double& way) const {
  Contacts contacts;
  const Vec3 x = in_body(grain.position);
  const auto add = [&](const DistanceSample& wall) {
    if (wall.distance < grain.radius) {
      if (has_normal(wall)) contacts.wall[contacts.count++] = in_world(wall);
    } else {
      way = std::min(way, (wall.distance - grain.radius) / steepest_);
    }
  };
  if (!several_) {
    way = std::numeric_limits<double>::infinity();
    add(body_.shape->sample(x));
    return contacts;
  }
  walls.come_to(*body_.shape, x, grain.radius);
  way = walls.way_left(x);
  for (int n = 0; n < walls.count(); ++n) {
    const int before = contacts.count;
    add(walls.seen_from(x, n));
    if (contacts.count > before && !walls.foot_found(n)) ++contacts.unsure;
  }
  return contacts;
}

template <TangentialModel tangential>
WallTouch SdfWall::touch(const GrainAtWall& grain, LocalWalls& walls, Vec3& displacement,
                         const TangentialStep& step, WallLoad& load) {
  WallTouch result;
  const Contacts contacts = find_contacts(grain, walls, result.way);
  load.unsure_contacts += contacts.unsure;
  if (contacts.count > 1 || (contacts.count == 1 && edge_springs(grain.tag))) {
    touch_edge<tangential>(grain, contacts, displacement, step, result, load);
  } else if (contacts.count == 1) {
    add_contact<tangential>(grain, contacts.wall[0], displacement, step, result, load);
  } else {
    displacement.setZero();
    forget(grain.tag);
    return result;
  }
  result.touches = true;
  return result;
}

// Springs of the last step go to the contacts with the nearest normals.
template <TangentialModel tangential>
void SdfWall::touch_edge(const GrainAtWall& grain, const Contacts& contacts, Vec3& displacement,
                         const TangentialStep& step, WallTouch& touch, WallLoad& load) {
  std::vector<EdgeSpring> before;
  if (const auto* known = edge_springs(grain.tag))
    before = *known;
  else
    before.push_back({contacts.wall[0].gradient.normalized(), displacement});
  std::vector<EdgeSpring> now;
  for (int w = 0; w < contacts.count; ++w) {
    now.push_back({contacts.wall[w].gradient.normalized(), Vec3::Zero()});
    for (const EdgeSpring& old : before)
      if ((turn_ * old.normal).dot(now.back().normal) > same_normal)
        now.back().displacement = old.displacement;
    add_contact<tangential>(grain, contacts.wall[w], now.back().displacement, step, touch, load);
  }
  displacement = now.size() == 1 ? now[0].displacement : Vec3::Zero();
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

template WallTouch SdfWall::touch<TangentialModel::off>(const GrainAtWall&, LocalWalls&, Vec3&,
                                                        const TangentialStep&, WallLoad&);
template WallTouch SdfWall::touch<TangentialModel::no_history>(const GrainAtWall&, LocalWalls&,
                                                               Vec3&, const TangentialStep&,
                                                               WallLoad&);
template WallTouch SdfWall::touch<TangentialModel::history>(const GrainAtWall&, LocalWalls&, Vec3&,
                                                            const TangentialStep&, WallLoad&);

}  // namespace gasgrain::plugins
