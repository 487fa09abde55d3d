// Viscous force of the gas: div( eps tau ), tau = mu (grad u + grad u^T).
#pragma once

#include "cfd/face_medium.hpp"
#include "cfd/gas_domain.hpp"

namespace gasgrain::cfd {

// Adds the term to `slope` [N/m^3] on the faces that take part; nothing when mu = 0. `velocity` and
// the void fraction have their ghosts filled and belong to the same time.
void add_viscous_stress(VectorField& slope, const GasDomain& domain, const FaceMedium& medium,
                        const VectorField& velocity);

}  // namespace gasgrain::cfd
