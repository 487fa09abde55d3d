// Momentum carried by the gas: -rho ( div(eps u u) - u div(eps u) ).
#pragma once

#include "cfd/face_medium.hpp"
#include "cfd/gas_case.hpp"
#include "cfd/gas_domain.hpp"

namespace gasgrain::cfd {

// Adds the term to `slope` [N/m^3] on the faces that take part. `velocity` and the void fraction
// have their ghosts filled and belong to the same time. `gas_flux` is work space.
void add_convection(VectorField& slope, const GasDomain& domain, const FaceMedium& medium,
                    const VectorField& velocity, Convection scheme, VectorField& gas_flux);

}  // namespace gasgrain::cfd
