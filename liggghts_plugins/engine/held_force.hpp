// A fix whose force on the grains is held between its actions (fix couple/gas), as the fused engine
// sees it. The engine adds the held forces itself instead of calling post_force(), and has the
// atom arrays ready only in steps that say they need them.
#pragma once

#include "coupling/shared/vec3.hpp"

namespace gasgrain::plugins {

// Force on local atom i: constant[i] - coefficients[i] * velocity, the velocity of the force
// computation, between the halves of the kick.
struct HeldForces {
  const Vec3* constant = nullptr;        // N; nullptr: no forces
  const double* coefficients = nullptr;  // kg/s; nullptr: no force follows the velocity

  Vec3 on(int i, const Vec3& velocity) const {
    return coefficients ? Vec3(constant[i] - coefficients[i] * velocity) : constant[i];
  }
};

class HeldForceFix {
 public:
  virtual ~HeldForceFix() = default;
  // Change only in end_of_step() and when atoms move between ranks.
  virtual HeldForces held_forces() const = 0;
  // Does what post_force() does besides adding the forces. `sum` of the forces on the local atoms,
  // N; 0 when none follows the velocity.
  virtual void held_forces_applied(const Vec3& sum) = 0;
  // Whether end_of_step() of the present step reads or changes atoms.
  virtual bool end_of_step_uses_atoms() const = 0;
};

}  // namespace gasgrain::plugins
