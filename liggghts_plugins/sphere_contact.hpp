// Kinematics and forces of one contact of two spheres, or of a sphere and a wall, without a host.
//
// Lever arms end in the middle of the overlap (r - overlap/2), for walls too, as in stock LIGGGHTS.
#pragma once

#include "liggghts_plugins/contact_law.hpp"
#include "liggghts_plugins/contact_settings.hpp"
#include "liggghts_plugins/surface_forces.hpp"

namespace gasgrain::plugins {

// How this grain stands to the other grain or the wall.
struct ContactState {
  Vec3 n;                  // unit vector from the other one to this grain
  double overlap;          // m; times |grad phi| for a field that is no exact distance
  Vec3 relative_velocity;  // of this grain's centre against the other's centre or the wall, m/s
  Vec3 lever_spin;         // sum of lever arm times angular velocity of the two, m/s
};

// Velocity of this grain's surface against the other one, within the contact plane, m/s.
inline Vec3 tangential_velocity(const ContactState& s) {
  return s.relative_velocity - s.relative_velocity.dot(s.n) * s.n + s.n.cross(s.lever_spin);
}

// Whether a call advances the tangential history or only looks at the present state (set-up of a
// run, computes that list contact forces).
enum class History { advance, keep };

struct TangentialStep {
  History history;
  double duration;  // s; times the tangential velocity this is the slip
};

// Tangential force on this grain, N. `displacement` (m) is used by TangentialModel::history alone.
template <TangentialModel model>
inline Vec3 tangential_force(const ContactCoefficients& c, double f_n, const ContactState& s,
                             Vec3& displacement, const TangentialStep& step) {
  if constexpr (model == TangentialModel::off) return Vec3::Zero();
  const Vec3 v_t = tangential_velocity(s);
  if constexpr (model == TangentialModel::no_history) return tangential_dashpot_force(c, f_n, v_t);
  const bool advance = step.history == History::advance;
  if (advance) advance_tangential_displacement(displacement, step.duration * v_t, s.n);
  const TangentialForce f = tangential_spring_force(c, f_n, displacement, v_t);
  if (f.sliding && advance) displacement = sliding_displacement(c, f.force);
  return f.force;
}

struct ContactForce {
  Vec3 force;   // on this grain, N
  Vec3 moment;  // force x n, N; times its lever arm the torque on either grain
};

template <TangentialModel model>
inline ContactForce contact_force(const ContactCoefficients& c, const ContactState& s,
                                  Vec3& displacement, const TangentialStep& step) {
  const double f_n = normal_force(c, s.overlap, s.relative_velocity.dot(s.n));
  const Vec3 f_t = tangential_force<model>(c, f_n, s, displacement, step);
  return {.force = f_n * s.n + f_t, .moment = f_t.cross(s.n)};
}

// Adds the adhesion to the force of a contact; returns the rolling torque on this grain, N m.
inline Vec3 add_surface_forces(const SurfaceForces& surface, const Vec3& n, const RollingPair& pair,
                               double duration, ContactForce& f) {
  const double load = std::abs(f.force.dot(n));
  f.force -= surface.adhesion * n;
  return rolling_torque(surface, load, n, pair, duration);
}

// Calls `run` with the tangential model as a template argument: run.template operator()<model>().
template <class Run>
inline auto with_tangential_model(TangentialModel model, const Run& run) {
  switch (model) {
    case TangentialModel::off:
      return run.template operator()<TangentialModel::off>();
    case TangentialModel::no_history:
      return run.template operator()<TangentialModel::no_history>();
    case TangentialModel::history:
      break;
  }
  return run.template operator()<TangentialModel::history>();
}

}  // namespace gasgrain::plugins
