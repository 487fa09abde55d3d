// Section [coupling.monitor] of a case file: docs/coupling.md.
#pragma once

#include <string>
#include <vector>

#include "cfd/grid.hpp"
#include "coupling/shared/config_table.hpp"

namespace gasgrain::coupling {

// A plane through which the flux of grains is measured.
struct FluxPlane {
  std::string name;
  int direction = 2;      // of its normal
  double position = 0.0;  // m
};

struct MonitorOptions {
  bool profile = false;               // file of the void fraction over the height
  double bubble_void_fraction = 0.0;  // gas cells above it make bubbles; 0: not looked for
  int mixing_direction = -1;          // along which the grains were layered at the start; -1: none
  std::vector<FluxPlane> planes;
};

// Throws UserError: unknown keys, values out of range, a plane outside the grid or named twice.
MonitorOptions read_monitor_options(const ConfigTable& table, const cfd::Grid& grid);

}  // namespace gasgrain::coupling
