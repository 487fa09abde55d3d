// The operator of the pressure equation and what every method of solving it needs.
#pragma once

#include "cfd/gas_regions.hpp"
#include "cfd/pressure_solver.hpp"

namespace gasgrain::cfd {

// image = A field on owned cells; returns the sum of field * image over this rank. The ghosts of
// `field` are filled.
double apply(Field& image, const PressureSystem& system, const Field& field);

// |b - A p| over all ranks, 2-norm. Fills the ghosts of `pressure`. Collective.
double residual_norm(const Decomposition& decomposition, const PressureSystem& system,
                     Field& pressure);

// |b| over all ranks, 2-norm. Collective.
double right_hand_side_norm(const Decomposition& decomposition, const PressureSystem& system);

// Round-off that the residual carries whatever the solution: machine epsilon times the 2-norm of
// the sums of its terms' magnitudes. Ghosts of `pressure` filled. Collective.
double residual_round_off(const Decomposition& decomposition, const PressureSystem& system,
                          const Field& pressure);

// p = 0 in cells without any coefficient.
void clear_isolated_cells(Field& pressure, const PressureSystem& system);

}  // namespace gasgrain::cfd
