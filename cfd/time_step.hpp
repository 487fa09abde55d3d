// Weights of the second-order Adams-Bashforth step and the largest steps that schemes are stable
// with.
#pragma once

#include "cfd/field.hpp"
#include "cfd/gas_domain.hpp"

namespace gasgrain::cfd {

// slope of the step = now * S_n + before * S_(n-1)
struct AdamsBashforth {
  double now = 1.0;
  double before = 0.0;
};

// `previous_dt` = 0 for the first step, which is Euler's. With r = dt / previous_dt the weights are
// 1 + r/2 and -r/2.
AdamsBashforth adams_bashforth(double dt, double previous_dt);

// Largest |u_d| over all faces of each direction, m/s. Collective.
Vec3 largest_speeds(const GasDomain& domain, const VectorField& velocity);

// Largest numbers a scheme is stable with.
struct Stability {
  double courant_number;    // |u| dt / h
  double diffusion_number;  // nu dt / h^2 in three directions
};
Stability stability_of(TimeScheme scheme);

// Largest step that explicit viscosity allows, s; infinite without viscosity.
double explicit_viscous_step(const GasDomain& domain, TimeScheme scheme);

enum class StepLimit { convection, viscosity, acceleration, stated };
inline constexpr int step_limit_count = 4;
const char* name_of(StepLimit limit);

// Largest step by each limit, s; infinite where it does not apply.
struct StepLimits {
  double convection;    // Courant number of the velocities there are and that inlets will have
  double viscosity;     // diffusion number in every direction that varies; explicit only
  double acceleration;  // Courant number after gravity and driving gradients acted for the step
  double stated;        // numerics.largest_step

  double smallest() const;
  StepLimit binding() const;  // the first of the smallest
};

// `acceleration` of the gas by gravity and driving gradients, m/s^2.
StepLimits step_limits(const GasDomain& domain, const Vec3& largest_speeds,
                       const Vec3& acceleration, const Numerics& numerics);

}  // namespace gasgrain::cfd
