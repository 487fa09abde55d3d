// Convection in the advective-consistent form: div(eps u u) - u div(eps u), summed over directions
//
//   ( F_hi (u_hi - u) - F_lo (u_lo - u) ) / h,      F = eps u,
//
// so that a uniform velocity feels nothing whatever the void fraction does, while the momentum flux
// is the one that div(eps u) implies. F is averaged to the sides of the face's control volume, the
// carried u is central or van Leer (1974): the value upwind plus a b / (a + b) for neighbouring
// differences a, b of one sign. Plain upwind is too diffusive (drag of a cylinder + 20 %).
//
// What the sides of the grid add: convection.cpp.
#pragma once

#include "cfd/face_medium.hpp"
#include "cfd/gas_case.hpp"
#include "cfd/gas_domain.hpp"

namespace gasgrain::cfd {

// What a side between face n - a and face n carries, for the flux through it along a.
struct CentralValue {
  static double carried(double, const double* u, std::ptrdiff_t n, std::ptrdiff_t a) {
    return 0.5 * (u[n - a] + u[n]);
  }
};

struct VanLeerValue {
  static double carried(double flux, const double* u, std::ptrdiff_t n, std::ptrdiff_t a) {
    // all four are read whatever the sign: loads that depend on it do not vectorize well
    const double under = u[n - 2 * a], below = u[n - a], above = u[n], over = u[n + a];
    const double behind = flux > 0.0 ? below - under : above - over;
    const double ahead = flux > 0.0 ? above - below : below - above;
    const double upwind = flux > 0.0 ? below : above;
    const double product = behind * ahead;
    return product > 0.0 ? upwind + product / (behind + ahead) : upwind;
  }
};

// F on faces.
struct GrainsFlux {
  const double* eps;
  const double* u;
  double operator[](std::ptrdiff_t n) const { return eps[n] * u[n]; }
};

struct PlainFlux {
  const double* u;
  double operator[](std::ptrdiff_t n) const { return u[n]; }
};

// visit(F of a direction) with what the faces carry.
template <class Visit>
void with_flux(const FaceMedium& medium, const VectorField& velocity, int direction,
               const Visit& visit) {
  const double* u = velocity[direction].data();
  if (medium.has_grains) {
    visit(GrainsFlux{medium.void_fraction[direction].data(), u});
  } else {
    visit(PlainFlux{u});
  }
}

// Adds what the sides of the grid do to component d of the slope, N/m^3. Returns its integral over
// the control volumes of this rank, N. Ghosts of `velocity` are filled.
double add_convection_on_sides(Field& slope, const GasDomain& domain, const FaceMedium& medium,
                               const VectorField& velocity, Convection scheme, int d);

}  // namespace gasgrain::cfd
