// The bed in layers along gravity, and the pressure drop.
#pragma once

#include "cfd/gas_solver.hpp"
#include "coupling/bed_layers.hpp"

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
  // The void fraction of the bed's surface, as the iso-surface of the paper's fig 3b.
  static constexpr double surface_void_fraction = 0.8;

  // Keeps references to `gas` and to `open_fraction`, as in Deposition, which may change.
  BedMonitor(const cfd::GasSolver& gas, const cfd::Field& open_fraction, const Vertical& vertical);

  // Takes the layers anew; the queries below are about them. Collective.
  void observe(const cfd::Field& void_fraction);

  const BedLayers& layers() const { return layers_; }
  // level_of_void_fraction() of the surface, m.
  double height() const { return level_of_void_fraction(layers_, surface_void_fraction); }
  // Mean pressure at the lower side minus that at the upper side, Pa. Collective.
  double pressure_drop() const;

  const Vertical& vertical() const { return vertical_; }
  double cross_section() const { return cross_section_; }  // of the whole grid, m^2

 private:
  const cfd::GasSolver& gas_;
  const cfd::Field& open_fraction_;
  Vertical vertical_;
  double cross_section_;
  BedLayers layers_;
};

}  // namespace gasgrain::coupling
