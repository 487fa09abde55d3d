// Adams-Bashforth of second order is stable on the negative real axis up to |lambda| dt = 1. The
// viscous operator of three directions reaches lambda = 12 nu / h^2, hence the limit of 1/12; on
// the imaginary axis it is only weakly unstable and van Leer's limiter damps what a Courant number
// of 0.25 leaves.
#include "cfd/time_step.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

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

double largest_stable_step(const GasDomain& domain, const Vec3& largest_speeds,
                           double courant_number) {
  const double nu = domain.gas.viscosity / domain.gas.density;
  double step = std::numeric_limits<double>::infinity();
  for (int d = 0; d < 3; ++d) {
    const double h = domain.spacing[d];
    const double gravity = domain.solved[d] ? std::abs(domain.gas.gravity[d]) : 0.0;
    step = std::min(step, transport_step(largest_speeds[d], gravity, courant_number * h));
    if (domain.varies[d] && nu > 0.0) {
      step = std::min(step, largest_diffusion_number * h * h / nu);
    }
  }
  return step;
}

}  // namespace gasgrain::cfd
