// Weights of the second-order Adams-Bashforth step and the largest step it is stable with.
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

// Largest step that keeps nu dt / h^2 <= 1/12 in every direction that varies, and the Courant
// number below `courant_number` even after gravity has acted on the gas for the step, s. Infinite
// when nothing limits it. Collective.
double largest_stable_step(const GasDomain& domain, const Vec3& largest_speeds,
                           double courant_number);

}  // namespace gasgrain::cfd
