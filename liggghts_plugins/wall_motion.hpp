// How a script says that a wall moves: keywords of fix wall/sdf.
//
//   translate VX VY VZ                     m/s
//   oscillate AX AY AZ PERIOD              m, s: displacement A sin(2 pi t/PERIOD)
//   rotate PX PY PZ AX AY AZ RATE          point of the axis (m), its direction, rad/s
//   start T, stop T                        s, of the three above
//   displacement v_X v_Y v_Z               variables of style equal, m; NULL: none
//   velocity v_X v_Y v_Z                   the same, m/s
//
// The first three may be combined; the variables stand alone.
#pragma once

#include <string>

#include "coupling/shared/motion.hpp"
#include "liggghts_plugins/contact_settings.hpp"
#include "liggghts_plugins/variable_motion.hpp"

namespace gasgrain::plugins {

struct WallMotion {
  Motion rigid;
  VariableMotion by_variable;

  bool exists() const { return !rigid.is_at_rest() || by_variable.exists(); }
};

// Reads the keyword that the arguments begin with; returns the number of words it took, 0 when it
// is none of those above. `where` begins every message. Throws UserError: words missing or
// malformed, zero axis, period not positive.
int read_motion_keyword(WallMotion& motion, Arguments arguments, const std::string& where);

// Throws UserError for keywords that contradict each other.
void check_motion(const WallMotion& motion, const std::string& where);

}  // namespace gasgrain::plugins
