// What moving bodies do to the gas next to them, besides imposing their velocity.
#pragma once

#include "cfd/gas_domain.hpp"

namespace gasgrain::cfd {

// Volume per time that the moving bodies leave to the gas of each owned cell, m^3/s: the flux of
// their velocity through the part of the cell's sides that they cover,
//
//   swept_c = sum over faces, outwards, of (a - a_0) A u_body,
//
// a: open share, a_0: the same with the resting bodies alone. Sums to zero over a body that does
// not cross the sides of the grid.
void set_swept_volume(Field& swept, const GasDomain& domain);

// Carries the solid volume of grains from the cells' old open shares to the new ones: what a cell
// can no longer hold goes to its neighbours. `void_fraction` (owned cells) is per open volume
// before and after. Returns the volume that found no place, m^3 of this rank.
double carry_grains(Field& void_fraction, const GasDomain& domain, const Field& old_open_share);

// Gives cells that were closed before the mean pressure of the neighbours that were open; ghosts
// of `pressure` are to be filled before and are filled after.
void fill_fresh_cells(Field& pressure, const GasDomain& domain, const Field& old_open_share);

}  // namespace gasgrain::cfd
