// Adhesion and rolling friction of a contact, on top of contact_law.hpp, as pure functions.
//
//   F_a = 2 pi w R0 L^((n+3)/2)      attraction along n while the surfaces touch
//   M_r = -mu_r R |F_n| w_r/|w_r|    on this grain, the opposite on the other one
//
// w is the work of adhesion of the originals (J/m^2), R0 their effective radius, R that of the
// grains, w_r the part of the relative spin that rolls (in the contact plane), F_n the load of
// spring and dashpot, which also limits the friction. F_a is the pull-off force of Derjaguin,
// Muller and Toporov (1975); with w = A/(12 pi h^2) it is van der Waals' A R0/(6 h^2) at the
// smallest separation h. The attraction beyond touching, nanometres against overlaps of
// micrometres, is left out.
//
// Scaling: F_a grows as the spring force does, l^((n+3)/2), and overlaps as l^((3-n)/2), so the
// energy of a bond grows as l^3, like the kinetic energy: grains stick at the speed at which the
// originals stick. mu_r does not scale: M_r grows as l F_n, so a grain that rolls slows down as the
// original does.
//
// Near rest M_r is at most what halves the relative spin in one step: a grain that should stand
// creeps at about 5 g sin(slope) times the step instead of being held by a spring.
#pragma once

#include <algorithm>

#include "coupling/shared/vec3.hpp"

namespace gasgrain::plugins {

struct SurfaceForces {
  double adhesion = 0.0;          // F_a, N
  double rolling_friction = 0.0;  // mu_r, -
};

struct RollingPair {
  Vec3 relative_spin;       // of this grain against the other or the wall, rad/s
  double effective_radius;  // r_i r_j / (r_i + r_j), against a wall r; m
  double inertia;           // I_i I_j / (I_i + I_j), against a wall I; kg m^2
};

// Moment of inertia of a sphere, kg m^2.
inline double sphere_inertia(double mass, double radius) {
  return 0.4 * mass * radius * radius;
}

// Torque on this grain, N m; `load` is |F_n| in N, `duration` that of a step in s.
inline Vec3 rolling_torque(const SurfaceForces& surface, double load, const Vec3& n,
                           const RollingPair& pair, double duration) {
  const Vec3 rolling = pair.relative_spin - pair.relative_spin.dot(n) * n;
  const double rate = rolling.norm();
  if (rate == 0.0) return Vec3::Zero();
  const double coulomb = surface.rolling_friction * pair.effective_radius * load;
  const double halving = 0.5 * pair.inertia * rate / duration;
  return (-std::min(coulomb, halving) / rate) * rolling;
}

}  // namespace gasgrain::plugins
