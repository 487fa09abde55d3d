// Boundary conditions that contradict each other or the bodies.
#pragma once

#include "cfd/gas_domain.hpp"
#include "cfd/gas_regions.hpp"

namespace gasgrain::cfd {

// Throws UserError when an inlet blows into a region without an outlet or a body covers all of an
// inlet or outlet. Where bodies move, the regions may change, so nothing is refused. Collective.
void check_boundaries(const GasDomain& domain, const GasRegions& regions);

}  // namespace gasgrain::cfd
