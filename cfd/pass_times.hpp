// What a gas step spends its time on.
#pragma once

#include <array>
#include <cstddef>

namespace gasgrain::cfd {

enum class Pass {
  slope,     // convection and viscous stress
  medium,    // void fraction and drag on the faces
  predict,   // steps 1 and 2 of the scheme
  boundary,  // step 3: sides and bodies
  equation,  // coefficients and right-hand side of the pressure equation
  solve,     // of the pressure equation, set-up included
  correct,   // step 5, ghosts and checks
  budget     // momentum and loads on bodies
};

inline constexpr std::array<const char*, 8> pass_names{"slope",    "medium", "predict", "boundary",
                                                       "equation", "solve",  "correct", "budget"};

struct PassTime {
  double wall = 0.0, cpu = 0.0;  // s, of this rank
};

using PassTimes = std::array<PassTime, pass_names.size()>;

// Times the passes of one step one after the other.
class PassClock {
 public:
  PassClock();
  // Books the time since the last call, or since construction, to `pass`.
  void finish(PassTimes& times, Pass pass);

 private:
  PassTime last_;
};

}  // namespace gasgrain::cfd
