// Values around the owned block: copies of the neighbours' and, outside the grid, what the boundary
// conditions say.
#pragma once

#include "cfd/gas_domain.hpp"

namespace gasgrain::cfd {

struct FaceMedium;

// Ghosts of a cell field; outside the grid the value of the nearest cell inside.
void fill_scalar_ghosts(const GasDomain& domain, Field& field);

// Sets the prescribed velocities on the sides of the grid (inlet: superficial velocity over void
// fraction; walls: 0) and fills all ghosts. Outside the grid:
//   tangential: mirrored about the side so that their mean is the wall's or inlet's velocity
//               (no-slip, inlet), or equal (slip, outlet);
//   normal:     odd about the value on the side, or equal to it (outlet).
void fill_velocity_ghosts(const GasDomain& domain, const FaceMedium& medium, VectorField& velocity);

}  // namespace gasgrain::cfd
