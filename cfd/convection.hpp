// Momentum carried by the gas: -rho ( div(eps u u) - u div(eps u) ).
#pragma once

#include "cfd/face_medium.hpp"
#include "cfd/gas_case.hpp"
#include "cfd/gas_domain.hpp"

namespace gasgrain::cfd {

// Adds component d of the term to `slope` [N/m^3] on the faces of `box`, a part of all owned faces.
// `velocity` and the void fraction have their ghosts filled and belong to the same time.
void add_convection(Field& slope, const GasDomain& domain, const IndexBox& box,
                    const FaceMedium& medium, const VectorField& velocity, Convection scheme,
                    int d);

// Adds what the sides of the grid do to component d. Returns its integral over the control volumes
// of this rank, N.
double add_convection_on_sides(Field& slope, const GasDomain& domain, const FaceMedium& medium,
                               const VectorField& velocity, Convection scheme, int d);

}  // namespace gasgrain::cfd
