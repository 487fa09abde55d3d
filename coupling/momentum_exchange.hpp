// Force of the gas on a grain and the coefficient by which it acts back on the gas (eq 13-15).
#pragma once

#include "coupling/grain_transfer.hpp"
#include "coupling/shared/drag.hpp"

namespace gasgrain::coupling {

struct DragOptions {
  DragClosure closure = drag_gidaspow;
  double density = 1.0;                 // rho of the gas, kg/m^3
  double viscosity = 1.8e-5;            // mu, Pa s
  double smallest_void_fraction = 0.2;  // in (0, 1]; the closure sees at least this eps
  bool mixture = false;                 // grains of several sizes: drag_in_mixture()
};

// The gas around a grain: the deposition kernel's mean over the cells.
struct SurroundingGas {
  double void_fraction;          // eps
  Vec3 velocity;                 // u, m/s
  double sauter_diameter = 0.0;  // of the original particles there, m; used for mixtures
};

// B = beta V / (1 - eps), kg/s: drag on the grain is B (u - v). The closure uses the diameter of
// the original particle and the volume is the grain's, V = l^3 V0, so that l^3 particles drag.
double exchange_coefficient(const GrainRecord& grain, const SurroundingGas& gas,
                            const DragOptions& options);

// True when the closure sees another void fraction than the gas has there.
bool void_fraction_is_limited(const SurroundingGas& gas, const DragOptions& options);

// Longest interval over which a grain may keep its drag without the exchange oscillating:
// 2 eps^2 (1 - eps) rho_s / beta = 2 eps^2 m / B, s.
double stable_exchange_interval(const GrainRecord& grain, double void_fraction,
                                double exchange_coefficient);

}  // namespace gasgrain::coupling
