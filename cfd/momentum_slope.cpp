#include "cfd/momentum_slope.hpp"

#include "cfd/convection.hpp"
#include "cfd/viscous_stress.hpp"

namespace gasgrain::cfd {

void evaluate(MomentumSlope& slope, const GasDomain& domain, const FaceMedium& medium,
              const VectorField& velocity, Convection scheme) {
  slope.convection = slope.viscous = Vec3::Zero();
  for (int d = 0; d < 3; ++d) {
    if (!domain.solved[d]) continue;
    Field& total = slope.total[d];
    const auto integral = [&, volume = domain.control_volume[d].data(),
                           value = total.data()](const IndexBox& box) {
      return sum_box(box, total, [=](std::ptrdiff_t n) { return volume[n] * value[n]; });
    };
    for_each_part(all_faces(domain, d), [&](const IndexBox& part) {
      for_box(part, total, [value = total.data()](std::ptrdiff_t n) { value[n] = 0.0; });
      add_convection(total, domain, part, medium, velocity, scheme, d);
      const double convection = integral(part);
      slope.convection[d] += convection;
      if (domain.gas.viscosity == 0.0) return;
      add_viscous_stress(total, domain, part, medium, velocity, d);
      slope.viscous[d] += integral(part) - convection;
    });
    slope.convection[d] += add_convection_on_sides(total, domain, medium, velocity, scheme, d);
  }
}

}  // namespace gasgrain::cfd
