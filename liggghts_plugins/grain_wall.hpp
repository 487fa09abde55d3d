// What the coupling needs to know of a wall of ours: the load of the grains on it.
#pragma once

#include <string>
#include <vector>

#include "coupling/shared/vec3.hpp"

namespace LAMMPS_NS {  // NOLINT(readability-identifier-naming): the name of LIGGGHTS
class LAMMPS;
}

namespace gasgrain::plugins {

// Impulse that grains give to a wall, between the ends of time steps, on this rank.
//
// Velocity Verlet applies the force of a step half in this step and half in the next, so the change
// of grain momentum from the end of step a to the end of step b is the trapezoidal sum of the
// forces: dt (F_a/2 + F_(a+1) + ... + F_b/2). This keeps that sum, so that the momentum balance
// closes to round-off.
class WallImpulse {
 public:
  // Force of the grains on the wall in the set-up of a run, N.
  void start(const Vec3& force) { last_force_ = force; }
  // The same in a step of duration dt, s.
  void add_step(const Vec3& force, double dt) {
    impulse_ += 0.5 * dt * (last_force_ + force);
    last_force_ = force;
  }
  // Impulse since the last call, N s; starts anew.
  Vec3 take();

 private:
  Vec3 impulse_ = Vec3::Zero();
  Vec3 last_force_ = Vec3::Zero();
};

// A wall that acts on grains: fix wall/sdf, or fix wall/gran with `model cgm`.
class GrainWall {
 public:
  explicit GrainWall(LAMMPS_NS::LAMMPS& lmp);
  virtual ~GrainWall();
  GrainWall(const GrainWall&) = delete;
  GrainWall& operator=(const GrainWall&) = delete;

  virtual std::string wall_name() const = 0;  // the fix's ID
  // Impulse of this rank's grains on the wall since the last call, N s. Valid at the end of a step
  // (or later than the wall's post_force: the force of the present step counts half).
  virtual Vec3 take_impulse() = 0;
  // Whether this rank knows that its surface moves, so that it works on the grains.
  virtual bool surface_moves() const = 0;

 private:
  LAMMPS_NS::LAMMPS& lmp_;
};

// All such walls of this LIGGGHTS instance, in the order of their creation.
std::vector<GrainWall*> grain_walls(LAMMPS_NS::LAMMPS& lmp);

}  // namespace gasgrain::plugins
