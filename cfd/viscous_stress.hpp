// Viscous force of the gas: div( eps tau ), tau = mu (grad u + grad u^T).
#pragma once

#include "cfd/face_medium.hpp"
#include "cfd/gas_domain.hpp"

namespace gasgrain::cfd {

// Adds component d of the term to `slope` [N/m^3] on the faces of `box`, a part of all owned faces;
// nothing when mu = 0. `velocity` and the void fraction have their ghosts filled and belong to the
// same time.
void add_viscous_stress(Field& slope, const GasDomain& domain, const IndexBox& box,
                        const FaceMedium& medium, const VectorField& velocity, int d);

}  // namespace gasgrain::cfd
