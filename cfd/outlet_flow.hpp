// Gas that comes back in through the outlets.
#pragma once

#include "cfd/face_medium.hpp"
#include "cfd/gas_domain.hpp"

namespace gasgrain::cfd {

// m^3/s that enter through outlets, all ranks; 0 without a communication when there are none.
double backflow(const GasDomain& domain, const FaceMedium& medium, const VectorField& velocity);

}  // namespace gasgrain::cfd
