// Drag closures: momentum exchange between gas and grains as pure functions (eq 13-15).
#pragma once

#include <string>
#include <vector>

namespace gasgrain {

struct DragInput {
  double void_fraction;  // eps, (0, 1]
  double diameter;       // d0 of the ORIGINAL particle, m, > 0
  double slip;           // |u - v|, m/s, >= 0
  double density;        // rho of the gas, kg/m^3, > 0
  double viscosity;      // mu of the gas, Pa s, > 0
};

// Returns beta / (1 - eps) in kg m^-3 s^-1: finite for a single grain (eps -> 1). The force on a
// grain of volume V is that times V (u - v). Beyond the range of its fit a formula is continued.
using DragClosure = double (*)(const DragInput&);

// Ergun (1952) for eps <= 0.8, Wen & Yu (1966) above (Gidaspow 1994); the paper's eq 13-15 with rho
// restored in the Wen-Yu branch. Schiller-Naumann drag coefficient, C_D = 0.44 from Re = 1000 on,
// Re = eps rho |u-v| d0 / mu.
double drag_gidaspow(const DragInput& input);

// The same with a smooth passage between the branches around eps = 0.8 (Huilin & Gidaspow 2003), so
// that a bed at the border does not jump between two forces 20 to 50 % apart.
double drag_gidaspow_blended(const DragInput& input);

// Di Felice (1994): drag of a single sphere times eps^-chi(Re).
double drag_difelice(const DragInput& input);
// Beetstra, van der Hoef, Kuipers (2007): lattice-Boltzmann simulations of sphere arrays.
double drag_beetstra(const DragInput& input);
// Hill, Koch, Ladd (2001) as given by Link et al. (2005): likewise.
double drag_koch_hill(const DragInput& input);
// Tenneti, Garg, Subramaniam (2011): particle-resolved simulations, eps >= 0.5, Re <= 300.
double drag_tenneti(const DragInput& input);
// Schiller & Naumann (1933): a single sphere, without influence of its neighbours.
double drag_schiller_naumann(const DragInput& input);

// Mixtures (van der Hoef, Beetstra, Kuipers 2005; Beetstra et al. 2007): the force on a grain of
// diameter d among others of Sauter mean diameter d_m is eps y + (1 - eps) y^2 times that on a
// grain of diameter d_m, y = d/d_m: proportional to d when alone, to d^2 in a dense bed, where the
// sum over all sizes is that of the mean grain. (Their small third term 0.064 eps y^3 is left out:
// with it equal grains would not feel what the closure says.) Returns beta/(1-eps) like a closure.
double drag_in_mixture(DragClosure closure, const DragInput& input, double sauter_diameter);

// The closure of that name (see drag_closure_names()), or nullptr.
DragClosure find_drag_closure(const std::string& name);
std::vector<std::string> drag_closure_names();

}  // namespace gasgrain
