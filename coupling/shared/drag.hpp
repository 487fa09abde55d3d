// Drag closures: momentum exchange between gas and grains as pure functions (eq 13-15).
#pragma once

#include <string>
#include <vector>

namespace gasgrain {

struct DragInput {
  double void_fraction;  // eps, (0, 1]
  double diameter;       // d0 of the ORIGINAL particle, m
  double slip;           // |u - v|, m/s
  double density;        // rho of the gas, kg/m^3
  double viscosity;      // mu of the gas, Pa s
};

// Returns beta / (1 - eps) in kg m^-3 s^-1: finite for a single grain (eps -> 1). The force on a
// grain of volume V is that times V (u - v).
using DragClosure = double (*)(const DragInput&);

// Ergun (1952) for eps <= 0.8, Wen & Yu (1966) above (Gidaspow 1994); the paper's eq 13-15 with rho
// restored in the Wen-Yu branch. Schiller-Naumann drag coefficient, C_D = 0.44 from Re = 1000 on,
// Re = eps rho |u-v| d0 / mu.
double drag_gidaspow(const DragInput& input);

// Di Felice (1994): drag of a single sphere times eps^-chi(Re).
double drag_difelice(const DragInput& input);
// Beetstra, van der Hoef, Kuipers (2007): lattice-Boltzmann simulations of sphere arrays.
double drag_beetstra(const DragInput& input);
// Hill, Koch, Ladd (2001) as given by Link et al. (2005): likewise.
double drag_koch_hill(const DragInput& input);
// Schiller & Naumann (1933): a single sphere, without influence of its neighbours.
double drag_schiller_naumann(const DragInput& input);

// The closure of that name (gidaspow, difelice, beetstra, koch-hill, schiller-naumann), or nullptr.
DragClosure find_drag_closure(const std::string& name);
std::vector<std::string> drag_closure_names();

}  // namespace gasgrain
