// The force of the gas on grains as the time integrator needs it: a held part and a linear one.
#pragma once

#include "coupling/shared/vec3.hpp"

namespace gasgrain {

// F(v) = held + coefficient * (reference_velocity - v). Held: -V grad p and everything else that
// does not follow the grain's velocity within a coupling interval, N. Coefficient: kg/s, >= 0.
struct GasForce {
  Vec3 held = Vec3::Zero();
  double coefficient = 0.0;
  Vec3 reference_velocity = Vec3::Zero();
};

// Source of the gas force on the local grains of this rank; index = local atom index, valid from one
// neighbour-list build to the next. `fix couple/gas` implements it.
class GasForceSource {
 public:
  virtual ~GasForceSource() = default;
  virtual GasForce gas_force(int local_index) const = 0;
};

}  // namespace gasgrain
