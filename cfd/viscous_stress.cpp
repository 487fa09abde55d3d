#include "cfd/viscous_stress.hpp"

namespace gasgrain::cfd {

void add_viscous_stress(Field& slope, const GasDomain& domain, const IndexBox& box,
                        const FaceMedium& medium, const VectorField& velocity, int d) {
  if (domain.gas.viscosity == 0.0) return;
  for (int e = 0; e < 3; ++e) {
    if (!domain.varies[e]) continue;
    const IndexBox faces = e == d ? intersection(box, inner_faces(domain, d)) : box;
    with_stress(domain, medium, velocity, d, e, [&](const auto& stress) {
      for_box(faces, slope, [=, a = slope.stride(e), sum = slope.data()](std::ptrdiff_t n) {
        sum[n] += stress(n + a) - stress(n);
      });
    });
  }
}

}  // namespace gasgrain::cfd
