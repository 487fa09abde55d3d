// The grains as the faces of the gas see them: void fraction and drag.
#pragma once

#include "cfd/edge_void_fraction.hpp"
#include "cfd/gas_domain.hpp"

namespace gasgrain::cfd {

struct GrainPhase;

// Without grains (eps = 1 and B = 0 everywhere) has_grains is false and the other members are not
// to be read; whoever uses them skips the terms.
struct FaceMedium {
  bool has_grains = false;
  Field cell_void_fraction;   // eps, ghosts filled (outside the grid: the value inside)
  VectorField void_fraction;  // eps_f on faces, also on the first two layers of ghost faces
  EdgeVoidFraction edges;     // eps on cell edges
  // Weights of the cell below and above a face, sum 1, both 0 where it does not take part.
  VectorField weight_below, weight_above;
  VectorField momentum_exchange;  // B_f on owned faces, kg m^-3 s^-1
  VectorField exchange_momentum;  // (B v)_f on owned faces, kg m^-2 s^-2
  // s on faces, with volume forcing or implicit viscosity, where it does not count as gas.
  VectorField density_scaling;
  bool has_scaling = false;
  // How grains share in the pressure gradient (cfd/felt_gradient.cpp): m, 0 when they feel it at
  // once; eps_f at the end of an interval of several steps, while it is divided.
  double lag = 0.0;
  VectorField coming_void_fraction;
  bool is_divided = false;

  bool shares_apart() const { return has_grains && (lag > 0.0 || is_divided); }
  const VectorField& sharing_void_fraction() const {
    return is_divided ? coming_void_fraction : void_fraction;
  }
  // Work space: values of cells that lend and of their hosts.
  std::array<std::vector<double>, 3> lent;
};

FaceMedium make_face_medium(const GasDomain& domain);

// What follows from the walls of the domain; again after they have moved.
void find_walls(FaceMedium& medium, const GasDomain& domain);

// Share-and-volume-weighted means of the cells' values: the transpose of what sample_at_cells
// gathers. Faces that do not take part get the mean void fraction of their two cells and no drag.
void update(FaceMedium& medium, const GasDomain& domain, GrainPhase& grains);

// Divides the interval: `end` is the cells' void fraction at its end.
void divide_interval(FaceMedium& medium, const GasDomain& domain, const Field& end);

// Of the pressure gradient and of that of the last interval: what the grains of a face feel per
// volume. Without lag and in an undivided interval 1 - eps and 0.
struct PressureShare {
  double now, last;
};
inline PressureShare pressure_share(double lag, double sharing_void_fraction) {
  const double solid = 1.0 - sharing_void_fraction, theta = 1.0 / (1.0 + lag * solid);
  return {theta * solid, (1.0 - theta) * solid};
}
inline double share_of_gas(const FaceMedium& medium, int direction, std::ptrdiff_t n) {
  if (!medium.has_grains) return 1.0;
  if (!medium.shares_apart()) return medium.void_fraction[direction][n];
  return 1.0 - pressure_share(medium.lag, medium.sharing_void_fraction()[direction][n]).now;
}

// s/eps dt / (rho (1 + K)), s = share_of_gas (eps in most cases), rho (1 + K) = rho + dt B/eps: the
// velocity that a unit pressure gradient removes in a step of dt [s], m^3 s/kg; less by the density
// scaling.
inline double mobility(const FaceMedium& medium, double density, double dt, int direction,
                       std::ptrdiff_t n) {
  const double inertia =
      medium.has_scaling ? density * medium.density_scaling[direction][n] : density;
  if (!medium.has_grains) return dt / inertia;
  const double eps = medium.void_fraction[direction][n];
  return share_of_gas(medium, direction, n) / eps * dt /
         (inertia + dt * medium.momentum_exchange[direction][n] / eps);
}

// s dt - eps (rho + dt B/eps) mobility: what density scaling keeps of the momentum that a
// unit pressure gradient would take per volume in a step, s.
inline double held_back(const FaceMedium& medium, double density, double dt, int direction,
                        std::ptrdiff_t n) {
  const double eps = medium.has_grains ? medium.void_fraction[direction][n] : 1.0;
  const double exchange = medium.has_grains ? medium.momentum_exchange[direction][n] : 0.0;
  const double inertia = density + dt * exchange / eps;
  return share_of_gas(medium, direction, n) * dt -
         eps * mobility(medium, density, dt, direction, n) * inertia;
}

// Void fraction of a face: 1 without grains.
inline double face_void_fraction(const FaceMedium& medium, int direction, std::ptrdiff_t n) {
  return medium.has_grains ? medium.void_fraction[direction][n] : 1.0;
}

}  // namespace gasgrain::cfd
