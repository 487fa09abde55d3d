// Convection on the sides of the grid (the scheme: convection.hpp).
//
// On an outlet the flow outside equals that on the face; what leaves carries the difference to the
// face before it. What comes back in comes from still surroundings: it carries no velocity, neither
// along the side nor across, so that it can bring no energy. Across the side that is
//
//   -rho u (u - 0)/h = -(rho u^2/2) / (h/2),
//
// the stated pressure acting as the total pressure of what enters. With Backflow::moving it carries
// the velocity it has.
#include "cfd/convection.hpp"

#include <algorithm>

namespace gasgrain::cfd {

namespace {

// Normal transport on the faces of an outlet, see the head of the file. Returns the integral.
template <class Flux>
double leave(Field& slope, const GasDomain& domain, int d, int side, const Flux& flux,
             const Field& velocity) {
  const double scale = domain.gas.density / domain.spacing[d];
  const std::ptrdiff_t inwards = (side == 0 ? 1 : -1) * slope.stride(d);
  double integral = 0.0;
  for_each_outlet_face(domain, d, side, [&](auto, auto n, const SideCondition& condition) {
    const double outflow = side == 0 ? -flux[n] : flux[n];
    const double carried = condition.backflow == Backflow::still ? 0.0 : velocity[n];
    const double change = -scale * (std::max(outflow, 0.0) * (velocity[n] - velocity[n + inwards]) +
                                    std::max(-outflow, 0.0) * (velocity[n] - carried));
    slope[n] += change;
    integral += domain.control_volume[d][n] * change;
  });
  return integral;
}

// Component d of what enters through an outlet across direction e: the mirrored value outside makes
// the carried value the velocity there is; this takes it away. Returns the integral.
template <class Flux>
double enter_still(Field& slope, const GasDomain& domain, int d, int e, int side, const Flux& flux,
                   const Field& velocity) {
  double integral = 0.0;
  if (!domain.sides.has(e, side, BoundaryType::outlet) ||
      !domain.decomposition.at_boundary(e, side))
    return integral;
  const Field& part = domain.walls.takes_part[d];
  const double scale = domain.gas.density / domain.spacing[e], inwards = side == 0 ? 1.0 : -1.0;
  const std::ptrdiff_t to_side = side == 1 ? slope.stride(e) : 0;
  const auto inflow = [&](Index3 cell, std::ptrdiff_t n) {
    const SideCondition& condition = domain.condition(e, side, cell);
    const bool enters =
        condition.type == BoundaryType::outlet && condition.backflow == Backflow::still;
    return enters ? std::max(inwards * flux[n + to_side], 0.0) : 0.0;
  };
  IndexBox box = all_faces(domain, d);
  box.begin[e] = domain.side_layer(e, side);
  box.end[e] = box.begin[e] + 1;
  for_each_in(box, [&](int i, int j, int k) {
    const std::ptrdiff_t n = slope.index(i, j, k);
    Index3 below{i, j, k};
    --below[d];
    const double sum = inflow({i, j, k}, n) + inflow(below, n - slope.stride(d));
    const double change = -scale * 0.5 * sum * part[n] * velocity[n];
    slope[n] += change;
    integral += domain.control_volume[d][n] * change;
  });
  return integral;
}

}  // namespace

double add_convection_on_sides(Field& slope, const GasDomain& domain, const FaceMedium& medium,
                               const VectorField& velocity, Convection scheme, int d) {
  double integral = 0.0;
  if (scheme == Convection::none) return integral;
  for (int side = 0; side < 2; ++side) {
    with_flux(medium, velocity, d, [&](const auto& flux) {
      integral += leave(slope, domain, d, side, flux, velocity[d]);
    });
    for (int e = 0; e < 3; ++e) {
      if (e == d || !domain.solved[e]) continue;
      with_flux(medium, velocity, e, [&](const auto& flux) {
        integral += enter_still(slope, domain, d, e, side, flux, velocity[d]);
      });
    }
  }
  return integral;
}

}  // namespace gasgrain::cfd
