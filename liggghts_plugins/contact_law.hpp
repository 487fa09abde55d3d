// Contact law of coarse grains (Mori, Wu, Sakai 2019, eq 7-9) as pure functions without a host.
//
//   F_n = k delta_n - eta v_n               along n, the unit vector from the other to this grain
//   F_t = -k_t delta_t - eta_t v_t          while |k_t delta_t| <= mu |F_n|
//       = -mu |F_n| delta_t / |delta_t|     otherwise: sliding, no dashpot; the spring is cut back
//                                           to the sliding force
//
// k, eta, k_t, eta_t are the grain's, scaled by GrainContact. The misprint of eq 9 (the slip test
// without mu, l^3 twice in the sliding force) is not repeated. The slip test looks at the spring
// alone, and delta_t is kept in the contact plane by projection, both as stock LIGGGHTS's
// `tangential history`, so that the two can be compared. F_n may be attractive in the last part of
// a damped contact, as eq 7 says.
#pragma once

#include <cmath>

#include "coupling/shared/vec3.hpp"

namespace gasgrain::plugins {

struct ContactCoefficients {
  double spring_constant;             // k, N/m, > 0
  double damping_coefficient;         // eta, kg/s, >= 0
  double tangential_spring_constant;  // k_t, N/m, > 0
  double tangential_damping;          // eta_t, kg/s, >= 0
  double friction_coefficient;        // mu, -, >= 0
};

// Normal force, N; overlap >= 0 in m; normal_velocity in m/s, positive when the surfaces separate.
inline double normal_force(const ContactCoefficients& c, double overlap, double normal_velocity) {
  return c.spring_constant * overlap - c.damping_coefficient * normal_velocity;
}

// Adds the slip of one step (m) to the displacement (m) and projects it onto the contact plane.
inline void advance_tangential_displacement(Vec3& displacement, const Vec3& slip, const Vec3& n) {
  displacement += slip;
  displacement -= displacement.dot(n) * n;
}

struct TangentialForce {
  Vec3 force;  // N
  bool sliding = false;
};

// Of spring and dashpot. The caller cuts the displacement (m) back when it slides.
inline TangentialForce tangential_spring_force(const ContactCoefficients& c, double normal_force,
                                               const Vec3& displacement, const Vec3& velocity) {
  const double spring = c.tangential_spring_constant * displacement.norm();
  const double limit = c.friction_coefficient * std::abs(normal_force);
  const Vec3 elastic = -c.tangential_spring_constant * displacement;
  if (spring > limit) return {.force = (limit / spring) * elastic, .sliding = true};
  return {.force = elastic - c.tangential_damping * velocity};
}

// Displacement, m, whose spring carries exactly the sliding force, N.
inline Vec3 sliding_displacement(const ContactCoefficients& c, const Vec3& sliding_force) {
  return (-1.0 / c.tangential_spring_constant) * sliding_force;
}

// Tangential force without history, N: the dashpot, limited by Coulomb friction.
inline Vec3 tangential_dashpot_force(const ContactCoefficients& c, double normal_force,
                                     const Vec3& velocity) {
  const double speed = velocity.norm();
  const double limit = c.friction_coefficient * std::abs(normal_force);
  if (c.tangential_damping * speed <= limit) return -c.tangential_damping * velocity;
  return (-limit / speed) * velocity;
}

}  // namespace gasgrain::plugins
