// Kinematics and forces of one contact of two spheres, or of a sphere and a wall, without a host.
//
// Lever arms end in the middle of the overlap (r - overlap/2), for walls too, as in stock LIGGGHTS.
#pragma once

#include "liggghts_plugins/contact_law.hpp"
#include "liggghts_plugins/contact_settings.hpp"

namespace gasgrain::plugins {

// The motion of the two surfaces relative to each other at the contact.
struct ContactMotion {
  double normal_velocity;    // m/s, > 0 when separating
  Vec3 tangential_velocity;  // m/s, of this grain's surface against the other one
};

// n points from the other grain (or the wall) to this one; lever_spin = sum of lever arm times
// angular velocity of the two, m/s.
inline ContactMotion contact_motion(const Vec3& relative_velocity, const Vec3& lever_spin,
                                    const Vec3& n) {
  const double v_n = relative_velocity.dot(n);
  return {.normal_velocity = v_n,
          .tangential_velocity = relative_velocity - v_n * n + n.cross(lever_spin)};
}

// Whether a call advances the tangential history or only looks at the present state (set-up of a
// run, computes that list contact forces).
enum class History { advance, keep };

struct TangentialStep {
  History history;
  double duration;  // m/s times this is the slip, s
};

// Tangential force on this grain, N. `displacement` (m) is used by TangentialModel::history alone.
template <TangentialModel model>
inline Vec3 tangential_force(const ContactCoefficients& c, double normal_force, const Vec3& n,
                             const Vec3& velocity, Vec3& displacement, const TangentialStep& step) {
  if constexpr (model == TangentialModel::off) return Vec3::Zero();
  if constexpr (model == TangentialModel::no_history)
    return tangential_dashpot_force(c, normal_force, velocity);
  const bool advance = step.history == History::advance;
  if (advance) advance_tangential_displacement(displacement, step.duration * velocity, n);
  const TangentialForce f = tangential_spring_force(c, normal_force, displacement, velocity);
  if (f.sliding && advance) displacement = sliding_displacement(c, f.force);
  return f.force;
}

}  // namespace gasgrain::plugins
