// Normal stresses sit in cell centres, shear stresses on cell edges. The full stress is needed:
// with a varying void fraction div u is not zero and the transposed part does not vanish.
//
// The normal stress of an outlet face does not change across its half control volume.
#include "cfd/viscous_stress.hpp"

namespace gasgrain::cfd {

namespace {

// Void fraction on the edge below cell n in the directions of strides a and b.
struct EdgeMean {
  const double* per_share;
  const double* gas;
  double operator()(std::ptrdiff_t n, std::ptrdiff_t a, std::ptrdiff_t b) const {
    return per_share[n] * (gas[n] + gas[n - a] + gas[n - b] + gas[n - a - b]);
  }
};

struct NoGrains {
  double operator()(std::ptrdiff_t, std::ptrdiff_t, std::ptrdiff_t) const { return 1.0; }
};

// Component d, change along e of the shear stress.
template <class Edge>
void add_shear(Field& slope, const GasDomain& domain, const IndexBox& box, const Edge& edge,
               const VectorField& velocity, int d, int e) {
  const double* u = velocity[d].data();
  const double* v = velocity[e].data();
  double* result = slope.data();
  const std::ptrdiff_t a = slope.stride(e), c = slope.stride(d);
  const double h = domain.spacing[e], transposed = domain.solved[e] ? h / domain.spacing[d] : 0.0;
  const double scale = domain.gas.viscosity / (h * h);
  for_each_row(box, slope, [=](std::ptrdiff_t row, int length) {
#pragma omp simd
    for (std::ptrdiff_t n = row; n < row + length; ++n) {
      const double hi = u[n + a] - u[n] + transposed * (v[n + a] - v[n + a - c]);
      const double lo = u[n] - u[n - a] + transposed * (v[n] - v[n - c]);
      result[n] += scale * (edge(n + a, a, c) * hi - edge(n, a, c) * lo);
    }
  });
}

void add_normal_stress(Field& slope, const GasDomain& domain, const IndexBox& box,
                       const FaceMedium& medium, const VectorField& velocity, int d) {
  const double* u = velocity[d].data();
  const double* eps = medium.cell_void_fraction.data();
  double* result = slope.data();
  const std::ptrdiff_t c = slope.stride(d);
  const double scale = 2.0 * domain.gas.viscosity / (domain.spacing[d] * domain.spacing[d]);
  for_each_row(
      intersection(box, inner_faces(domain, d)), slope, [=](std::ptrdiff_t row, int length) {
#pragma omp simd
        for (std::ptrdiff_t n = row; n < row + length; ++n) {
          const double difference = eps[n] * (u[n + c] - u[n]) - eps[n - c] * (u[n] - u[n - c]);
          result[n] += scale * difference;
        }
      });
}

}  // namespace

void add_viscous_stress(Field& slope, const GasDomain& domain, const IndexBox& box,
                        const FaceMedium& medium, const VectorField& velocity, int d) {
  if (domain.gas.viscosity == 0.0) return;
  if (domain.varies[d]) add_normal_stress(slope, domain, box, medium, velocity, d);
  for (int e = 0; e < 3; ++e) {
    if (e == d || !domain.varies[e]) continue;
    if (medium.has_grains) {
      const EdgeVoidFraction& edges = medium.edges;
      const EdgeMean edge{edges.per_share[3 - d - e].data(), edges.gas.data()};
      add_shear(slope, domain, box, edge, velocity, d, e);
    } else {
      add_shear(slope, domain, box, NoGrains{}, velocity, d, e);
    }
  }
}

}  // namespace gasgrain::cfd
