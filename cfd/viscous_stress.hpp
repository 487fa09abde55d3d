// Viscous stress div(eps tau), tau = mu (grad u + grad u^T), on faces.
//
// Normal stresses sit in cell centres, shear stresses on cell edges. The full stress is needed:
// with a varying void fraction div u is not zero and the transposed part does not vanish.
#pragma once

#include "cfd/face_medium.hpp"
#include "cfd/gas_domain.hpp"

namespace gasgrain::cfd {

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

// eps tau over the spacing, N/m^3, in the cell below face n, for the direction of the component.
struct NormalStress {
  const double* eps;
  const double* u;
  std::ptrdiff_t c;
  double scale;  // 2 mu / h^2
  double operator()(std::ptrdiff_t n) const { return scale * (eps[n - c] * (u[n] - u[n - c])); }
};

// The same on the edge below face n in another direction, of stride a.
template <class Edge>
struct ShearStress {
  Edge edge;
  const double* u;  // the component, of stride c
  const double* v;  // that of the other direction
  std::ptrdiff_t a, c;
  double scale;       // mu / h^2
  double transposed;  // h / spacing along c; 0 when v is not solved for
  double operator()(std::ptrdiff_t n) const {
    return scale * (edge(n, a, c) * (u[n] - u[n - a] + transposed * (v[n] - v[n - c])));
  }
};

// visit(stress) with the stress of component d on the sides of its control volumes across direction
// e, a function of the storage index of the face above the side. div(eps tau) gets from it
// stress(n + stride of e) - stress(n).
template <class Visit>
void with_stress(const GasDomain& domain, const FaceMedium& medium, const VectorField& velocity,
                 int d, int e, const Visit& visit) {
  const double h = domain.spacing[e], scale = domain.gas.viscosity / (h * h);
  const double* u = velocity[d].data();
  const std::ptrdiff_t c = velocity[d].stride(d), a = velocity[d].stride(e);
  if (e == d) {
    visit(NormalStress{medium.cell_void_fraction.data(), u, c, 2.0 * scale});
    return;
  }
  const double* v = velocity[e].data();
  const double transposed = domain.solved[e] ? h / domain.spacing[d] : 0.0;
  if (medium.has_grains) {
    const EdgeMean edge{medium.edges.per_share[3 - d - e].data(), medium.edges.gas.data()};
    visit(ShearStress<EdgeMean>{edge, u, v, a, c, scale, transposed});
  } else {
    visit(ShearStress<NoGrains>{{}, u, v, a, c, scale, transposed});
  }
}

// Adds component d of div(eps tau) to `slope` [N/m^3] on the faces of `box`, a part of all owned
// faces. `velocity` and the void fraction have their ghosts filled. The normal stress of an outlet
// face does not change across its half control volume.
void add_viscous_stress(Field& slope, const GasDomain& domain, const IndexBox& box,
                        const FaceMedium& medium, const VectorField& velocity, int d);

}  // namespace gasgrain::cfd
