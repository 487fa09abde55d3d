// Pressure and flux on the sides of the grid, as time series and summaries show them.
#pragma once

#include <string>
#include <vector>

#include "cfd/gas_solver.hpp"

namespace gasgrain::cfd {

struct SideState {
  std::string name;       // "z_lower"; also for the pair of a periodic direction
  bool periodic = false;  // then without pressure
  double pressure = 0.0;  // Pa, mean over the open area
  double flux = 0.0;      // m^3/s, positive along the direction
};

// Collective.
std::vector<SideState> side_states(const GasSolver& solver);

}  // namespace gasgrain::cfd
