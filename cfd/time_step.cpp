// Adams-Bashforth of second order is stable on the negative real axis up to |lambda| dt = 1. The
// viscous operator of three directions reaches lambda = 12 nu / h^2, hence the limit of 1/12; on
// the imaginary axis it is only weakly unstable and van Leer's limiter damps what a Courant number
// of 0.25 leaves.
#include "cfd/time_step.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cfd/halo_exchange.hpp"
#include "coupling/shared/error.hpp"

namespace gasgrain::cfd {

namespace {

constexpr double largest_diffusion_number = 1.0 / 12.0;

// Step after which u + g dt crosses `courant_number` cells of length h: u dt + g dt^2 = C h.
double transport_step(double speed, double gravity, double distance) {
  if (gravity == 0.0) {
    return speed > 0.0 ? distance / speed : std::numeric_limits<double>::infinity();
  }
  return 2.0 * distance / (speed + std::sqrt(speed * speed + 4.0 * gravity * distance));
}

double largest_speed(const GasDomain& domain, const Field& component, int d) {
  double largest = 0.0;
  for_each_face(domain.decomposition, d, [&](int i, int j, int k) {
    largest = std::max(largest, std::abs(component(i, j, k)));
  });
  return max_over_ranks(domain.decomposition, largest);
}

}  // namespace

AdamsBashforth adams_bashforth(double dt, double previous_dt) {
  GASGRAIN_ASSERT(dt > 0.0 && previous_dt >= 0.0);
  if (previous_dt == 0.0) return {};
  const double r = dt / previous_dt;
  return {1.0 + 0.5 * r, -0.5 * r};
}

double largest_courant_rate(const GasDomain& domain, const VectorField& velocity) {
  double rate = 0.0;
  for (int d = 0; d < 3; ++d) {
    rate = std::max(rate, largest_speed(domain, velocity[d], d) / domain.spacing[d]);
  }
  return rate;
}

double largest_stable_step(const GasDomain& domain, const VectorField& velocity,
                           double courant_number) {
  const double nu = domain.gas.viscosity / domain.gas.density;
  double step = std::numeric_limits<double>::infinity();
  for (int d = 0; d < 3; ++d) {
    const double h = domain.spacing[d];
    const double gravity = domain.solved[d] ? std::abs(domain.gas.gravity[d]) : 0.0;
    const double speed = largest_speed(domain, velocity[d], d);
    step = std::min(step, transport_step(speed, gravity, courant_number * h));
    if (domain.varies[d] && nu > 0.0) {
      step = std::min(step, largest_diffusion_number * h * h / nu);
    }
  }
  return step;
}

}  // namespace gasgrain::cfd
