// A fix whose force on the grains is held between its actions (fix couple/gas), as the fused engine
// sees it. The engine adds the held forces itself instead of calling post_force(), and has the
// atom arrays ready only in steps that say they need them.
#pragma once

#include "coupling/shared/vec3.hpp"

namespace gasgrain::plugins {

class HeldForceFix {
 public:
  virtual ~HeldForceFix() = default;
  // Force on each local atom, N; changes only in end_of_step() and when atoms move between ranks.
  virtual const Vec3* held_forces() const = 0;
  // Does what post_force() does besides adding the forces.
  virtual void held_forces_applied() = 0;
  // Whether end_of_step() of the present step reads or changes atoms.
  virtual bool end_of_step_uses_atoms() const = 0;
};

}  // namespace gasgrain::plugins
