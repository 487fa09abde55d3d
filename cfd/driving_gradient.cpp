// A periodic direction has p = G x + p', p' periodic. G acts with gravity in step 1 of the scheme,
// before bodies are imposed, and belongs to grad p everywhere afterwards. With a prescribed mean
// flow q (superficial, over the whole cross-section) the step's G follows from u*, which a change
// of G changes by -c/eps dG:
//
//   dG = (<a eps u*> - q - o) / <a c>,     c = eps dt / (rho (1 + K)).
//
// Where bodies or grains stand in the flow the projection takes some of the mean away, the impulse
// of p' on them. The offset o is the sum of what was missing after earlier steps, so that the flow
// itself, not u*, settles at q.
#include "cfd/driving_gradient.hpp"

#include "cfd/halo_exchange.hpp"
#include "cfd/projection.hpp"

namespace gasgrain::cfd {

DrivingGradient::DrivingGradient(const GasDomain& domain) : domain_(domain) {
  for (const SidePart& part : domain.sides.parts()) {
    const Boundary& stated = part.stated;
    if (stated.type != BoundaryType::periodic || part.side != 0) continue;
    value_[part.direction] = stated.pressure_gradient;
    flow_is_given_[part.direction] = stated.mean_velocity.has_value();
    mean_velocity_[part.direction] = stated.mean_velocity.value_or(0.0);
    present_ = present_ || stated.pressure_gradient != 0.0 || stated.mean_velocity.has_value();
  }
}

double DrivingGradient::mean_flow(const VectorField& velocity, const FaceMedium& medium,
                                  int d) const {
  const Field& open = domain_.walls.open_area[d];
  double flux = 0.0;
  for_each_face(domain_.decomposition, d, [&](int i, int j, int k) {
    const std::ptrdiff_t n = open.index(i, j, k);
    flux += open[n] * face_void_fraction(medium, d, n) * velocity[d][n];
  });
  const Index3& cells = domain_.decomposition.grid().cells;
  return sum_over_ranks(domain_.decomposition, flux) / (double(cells[0]) * cells[1] * cells[2]);
}

void DrivingGradient::observe(const VectorField& velocity, const FaceMedium& medium) {
  for (int d = 0; d < 3; ++d) {
    if (!flow_is_given_[d] || !domain_.solved[d]) continue;
    offset_[d] += mean_velocity_[d] - mean_flow(velocity, medium, d);
  }
}

void DrivingGradient::keep_mean_flow(VectorField& velocity, const FaceMedium& medium, double dt) {
  for (int d = 0; d < 3; ++d) {
    if (!flow_is_given_[d] || !domain_.solved[d]) continue;
    const Field &part = domain_.walls.takes_part[d], &open = domain_.walls.open_area[d];
    double response = 0.0;
    for_each_face(domain_.decomposition, d, [&](int i, int j, int k) {
      const std::ptrdiff_t n = part.index(i, j, k);
      response += part[n] * open[n] * face_void_fraction(medium, d, n) *
                  mobility(medium, domain_.gas.density, dt, d, n);
    });
    const Index3& cells = domain_.decomposition.grid().cells;
    response =
        sum_over_ranks(domain_.decomposition, response) / (double(cells[0]) * cells[1] * cells[2]);
    const double wanted = mean_velocity_[d] + offset_[d];
    const double change = (mean_flow(velocity, medium, d) - wanted) / response;
    value_[d] += change;
    for_each_face(domain_.decomposition, d, [&](int i, int j, int k) {
      const std::ptrdiff_t n = part.index(i, j, k);
      velocity[d][n] -= part[n] * change * mobility(medium, domain_.gas.density, dt, d, n);
    });
  }
}

void DrivingGradient::add_to(VectorField& pressure_gradient) const {
  for (int d = 0; d < 3; ++d) {
    if (value_[d] == 0.0) continue;
    const Field& part = domain_.walls.takes_part[d];
    for (std::size_t n = 0; n < part.count(); ++n) pressure_gradient[d][n] += part[n] * value_[d];
  }
}

}  // namespace gasgrain::cfd
