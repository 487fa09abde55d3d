// How many DEM steps pass between two exchanges with the gas.
#pragma once

#include <string>

namespace gasgrain::coupling {

// Upper limits of the interval between exchanges, s; infinity where there is none.
struct IntervalLimits {
  double grain_motion;  // 0.1 d / largest grain speed: the void fraction follows the grains
  double exchange;      // 2 eps^2 m / B, smallest over the grains: the held drag oscillates beyond
  double wall_motion;   // 0.1 of the least spacing / largest speed of a wall: likewise
  double gas;           // largest stable step of the gas solver
};

struct CouplingInterval {
  int dem_steps = 1;       // DEM steps to the next exchange
  std::string limited_by;  // which limit decided, for the user
};

// Default: the least of the two motion limits, 5 % of the exchange limit and the gas limit. A
// `requested` interval > 0 [s] takes the place of all but half the exchange limit; the gas then
// subdivides it. A whole number of DEM steps (of `dem_step` > 0, s), from one to a million.
CouplingInterval choose_interval(const IntervalLimits& limits, double dem_step, double requested);

}  // namespace gasgrain::coupling
