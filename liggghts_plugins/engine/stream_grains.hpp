// Grains that fix insert/stream has inserted and not yet released: until its release step such a
// grain moves on a straight line, whatever acts on it, and other grains feel it.
//
//   x(n) = x_i + (n - i) dt v_i   for n <= r,   then v = v_r, omega = omega_r without a force
//
// i: step of insertion, r: step of release (LIGGGHTS 3.8.0, fix insert/stream, which does it for
// all grains at the end of every step; the engine does it for these grains only).
#pragma once

#include <vector>

#include "liggghts_plugins/engine/grain_loop.hpp"

namespace LAMMPS_NS {  // NOLINT(readability-identifier-naming): the name of LIGGGHTS
class Fix;
class LAMMPS;
}  // namespace LAMMPS_NS

namespace gasgrain::plugins {

class StreamGrains {
 public:
  // Finds the grains whose release step is `step` or later. `stream`: the first fix insert/stream,
  // which acts for all of them, or nullptr.
  void load(LAMMPS_NS::LAMMPS& lmp, const LAMMPS_NS::Fix* stream, long step);

  // Takes those that were released before `step` off the list, and has the others stay where they
  // are put.
  void hold(GrainLoop& loop, long step);
  // Puts the grains where they are at `step`, of dt [s]; those that were released in the step
  // before have made a step with their new velocity, and go on like all others.
  void place(GrainLoop& loop, long step, double dt);

  double square_speed() const { return square_speed_; }  // largest, m^2/s^2; 0 without grains

 private:
  struct Grain {
    int index;
    long inserted, released;
    Vec3 start;          // m
    Vec3 velocity;       // until the release, m/s
    Vec3 velocity_then;  // m/s
    Vec3 spin_then;      // rad/s
  };

  std::vector<Grain> grains_;
  double square_speed_ = 0.0;
};

}  // namespace gasgrain::plugins
