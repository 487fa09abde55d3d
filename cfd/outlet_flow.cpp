#include "cfd/outlet_flow.hpp"

#include <algorithm>

#include "cfd/halo_exchange.hpp"

namespace gasgrain::cfd {

double backflow(const GasDomain& domain, const FaceMedium& medium, const VectorField& velocity) {
  double sum = 0.0;
  bool any = false;
  for (int d = 0; d < 3; ++d) {
    for (int side = 0; side < 2; ++side) {
      any = any || domain.sides.has(d, side, BoundaryType::outlet);
      const double inwards = side == 0 ? 1.0 : -1.0;
      for_each_outlet_face(domain, d, side, [&](auto, auto face, const SideCondition&) {
        const double flux = domain.walls.open_area[d][face] * domain.face_area(d) *
                            face_void_fraction(medium, d, face) * velocity[d][face];
        sum += std::max(inwards * flux, 0.0);
      });
    }
  }
  return any ? sum_over_ranks(domain.decomposition, sum) : 0.0;
}

}  // namespace gasgrain::cfd
