// The pressure equation by a solver of hypre.
#pragma once

#include "cfd/pressure_solver.hpp"

namespace gasgrain::cfd {

std::unique_ptr<PressureSolver> make_hypre_solver(const Decomposition& decomposition,
                                                  PressureMethod method);

}  // namespace gasgrain::cfd
