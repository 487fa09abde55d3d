// The pressure equation by our own conjugate gradients with a multigrid preconditioner.
#pragma once

#include "cfd/pressure_solver.hpp"

namespace gasgrain::cfd {

std::unique_ptr<PressureSolver> make_multigrid_solver(const Decomposition& decomposition);

}  // namespace gasgrain::cfd
