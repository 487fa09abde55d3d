// Adams-Bashforth of second order is stable on the negative real axis up to |lambda| dt = 1. The
// viscous operator of three directions reaches lambda = 12 nu / h^2, hence a limit of 1/12, of
// which nine tenths are used: at the limit itself the least convection makes the shortest waves
// grow; on the imaginary axis it is only weakly unstable and van Leer's limiter damps what a
// Courant number of 0.25 leaves. Heun's method (two stages, strong stability preserving) reaches
// |lambda| dt = 2, hence twice both numbers, for twice the work of a step: no faster, but it starts
// itself and its error is smaller where boundaries change abruptly.
#include "cfd/time_step.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "coupling/shared/error.hpp"

namespace gasgrain::cfd {

namespace {

constexpr double viscous_margin = 0.9;

// Step after which u + g dt crosses `distance`: u dt + g dt^2 = C h.
double transport_step(double speed, double acceleration, double distance) {
  return 2.0 * distance / (speed + std::sqrt(speed * speed + 4.0 * acceleration * distance));
}

}  // namespace

AdamsBashforth adams_bashforth(double dt, double previous_dt) {
  GASGRAIN_ASSERT(dt > 0.0 && previous_dt >= 0.0);
  if (previous_dt == 0.0) return {};
  const double r = dt / previous_dt;
  return {1.0 + 0.5 * r, -0.5 * r};
}

Vec3 largest_speeds(const GasDomain& domain, const VectorField& velocity) {
  Vec3 largest = Vec3::Zero();
  for (int d = 0; d < 3; ++d) {
    largest[d] = max_box(all_faces(domain, d), velocity[d],
                         [u = velocity[d].data()](std::ptrdiff_t n) { return std::abs(u[n]); });
  }
  if (domain.decomposition.size() == 1) return largest;
  MPI_Allreduce(MPI_IN_PLACE, largest.data(), 3, MPI_DOUBLE, MPI_MAX,
                domain.decomposition.communicator());
  return largest;
}

Stability stability_of(TimeScheme scheme) {
  if (scheme == TimeScheme::rk2)
    return {.courant_number = 0.5, .diffusion_number = viscous_margin / 6.0};
  return {.courant_number = 0.25, .diffusion_number = viscous_margin / 12.0};
}

double explicit_viscous_step(const GasDomain& domain, TimeScheme scheme) {
  const double nu = domain.gas.viscosity / domain.gas.density;
  double step = std::numeric_limits<double>::infinity();
  for (int d = 0; d < 3; ++d) {
    if (!domain.varies[d] || nu == 0.0) continue;
    const double h = domain.spacing[d];
    step = std::min(step, stability_of(scheme).diffusion_number * h * h / nu);
  }
  return step;
}

const char* name_of(StepLimit limit) {
  constexpr std::array<const char*, step_limit_count> names{"convection", "viscosity",
                                                            "acceleration", "stated"};
  return names[static_cast<int>(limit)];
}

double StepLimits::smallest() const {
  return std::min({convection, viscosity, acceleration, stated});
}

StepLimit StepLimits::binding() const {
  const std::array<double, step_limit_count> all{convection, viscosity, acceleration, stated};
  return static_cast<StepLimit>(std::min_element(all.begin(), all.end()) - all.begin());
}

StepLimits step_limits(const GasDomain& domain, const Vec3& largest_speeds,
                       const Vec3& acceleration, const Numerics& numerics) {
  const Vec3 speeds = largest_speeds.cwiseMax(domain.sides.largest_speeds());
  const double never = std::numeric_limits<double>::infinity();
  StepLimits limits{never, never, never, numerics.largest_step};
  for (int d = 0; d < 3; ++d) {
    const double h = domain.spacing[d], distance = numerics.courant_number * h;
    if (speeds[d] > 0.0) {
      limits.convection = std::min(limits.convection, distance / speeds[d]);
    }
    const double push = domain.solved[d] ? std::abs(acceleration[d]) : 0.0;
    if (push > 0.0) {
      limits.acceleration =
          std::min(limits.acceleration, transport_step(speeds[d], push, distance));
    }
  }
  if (numerics.viscosity == Viscosity::explicit_step) {
    limits.viscosity = explicit_viscous_step(domain, numerics.time_scheme);
  }
  return limits;
}

}  // namespace gasgrain::cfd
