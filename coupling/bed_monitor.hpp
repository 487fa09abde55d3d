// Bed height and pressure drop along gravity.
#pragma once

#include <vector>

#include "cfd/gas_solver.hpp"

namespace gasgrain::coupling {

// The grid direction that is vertical, and which way is up.
struct Vertical {
  int axis = 2;
  int up = 1;  // +1 or -1 along the axis

  int lower_side() const { return up > 0 ? 0 : 1; }
  int upper_side() const { return 1 - lower_side(); }
};

// The direction closest to -gravity; z when there is no gravity.
Vertical vertical_of(const Vec3& gravity);

class BedMonitor {
 public:
  // Keeps a reference to `gas`. `open_fraction` as in Deposition. Collective.
  BedMonitor(const cfd::GasSolver& gas, const cfd::Field& open_fraction, const Vertical& vertical);

  // Highest level, in m above the lower end of the grid, at which the void fraction averaged over
  // the open part of horizontal layers crosses 0.8, linearly between the layers' centres; 0 for an
  // empty grid. Collective.
  double height(const cfd::Field& void_fraction) const;
  // Mean pressure at the lower side minus that at the upper side, Pa. Collective.
  double pressure_drop() const;

  const Vertical& vertical() const { return vertical_; }
  double cross_section() const { return cross_section_; }  // of the whole grid, m^2
  // Volume that the bodies leave open below `height`, m^3.
  double open_volume_below(double height) const;

 private:
  std::vector<double> layer_sums(const cfd::Field& field) const;

  const cfd::GasSolver& gas_;
  cfd::Field open_fraction_;
  Vertical vertical_;
  double cross_section_, layer_height_;
  std::vector<double> open_cells_;  // per layer from below, in cell volumes
};

}  // namespace gasgrain::coupling
