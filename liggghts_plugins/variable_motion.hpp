// Translation of a wall by LIGGGHTS variables of style equal: its displacement, or its velocity.
//
//   displacement:  s(t) = values,                      u = (s(t) - s(t - dt))/dt
//   velocity:      s(t) = s(t - dt) + dt/2 (u(t - dt) + u(t)),   u(t) = values
//
// Evaluated once per step on every rank. u of a displacement is 0 in the first step that sees it.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "coupling/shared/vec3.hpp"

namespace LAMMPS_NS {  // NOLINT(readability-identifier-naming): the name of LIGGGHTS
class LAMMPS;
}

namespace gasgrain::plugins {

class VariableMotion {
 public:
  enum class Kind { none, displacement, velocity };

  VariableMotion() = default;
  // `words`: v_name of each direction, or NULL: does not move in it. `where` begins every message.
  // Throws UserError for other words.
  VariableMotion(Kind kind, char** words, const std::string& where);

  bool exists() const { return kind_ != Kind::none; }
  // Throws UserError when a variable is missing or not of style equal.
  void check(LAMMPS_NS::LAMMPS& lmp, const std::string& where) const;
  // The variables depend on nothing but the time: numbers, functions, step, dt, time, and other
  // such variables.
  bool follows_time(LAMMPS_NS::LAMMPS& lmp) const;

  // Goes on to the present step; false when it is there already.
  bool advance(LAMMPS_NS::LAMMPS& lmp);
  const Vec3& displacement() const { return displacement_; }  // m
  const Vec3& velocity() const { return velocity_; }          // m/s
  double last_way() const { return last_way_; }               // m, between the last two steps

  std::vector<double> state() const;
  void set_state(const double* state);

 private:
  Vec3 values(LAMMPS_NS::LAMMPS& lmp) const;

  Kind kind_ = Kind::none;
  std::array<std::string, 3> names_;  // "" = none
  Vec3 displacement_ = Vec3::Zero();
  Vec3 velocity_ = Vec3::Zero();
  double last_way_ = 0.0;
  double last_step_ = -1.0;  // -1: not evaluated yet
};

}  // namespace gasgrain::plugins
