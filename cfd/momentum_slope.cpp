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
    const bool apart = slope.stress[d].count() > 0;
    Field& stress = apart ? slope.stress[d] : total;
    const auto integral = [volume = domain.control_volume[d].data()](const IndexBox& box,
                                                                     const Field& field) {
      return sum_box(box, field,
                     [=, value = field.data()](std::ptrdiff_t n) { return volume[n] * value[n]; });
    };
    const auto clear = [](const IndexBox& box, Field& field) {
      for_box(box, field, [value = field.data()](std::ptrdiff_t n) { value[n] = 0.0; });
    };
    for_each_part(all_faces(domain, d), [&](const IndexBox& part) {
      clear(part, total);
      add_convection(total, domain, part, medium, velocity, scheme, d);
      const double convection = integral(part, total);
      slope.convection[d] += convection;
      if (domain.gas.viscosity == 0.0) return;
      if (apart) clear(part, stress);
      add_viscous_stress(stress, domain, part, medium, velocity, d);
      slope.viscous[d] += integral(part, stress) - (apart ? 0.0 : convection);
    });
    slope.convection[d] += add_convection_on_sides(total, domain, medium, velocity, scheme, d);
  }
}

}  // namespace gasgrain::cfd
