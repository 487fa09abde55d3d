// div( a c grad p ) = right-hand side on the cells of the grid: the pressure equation.
#pragma once

#include <memory>

#include "cfd/field.hpp"
#include "cfd/grid.hpp"

namespace gasgrain::cfd {

struct GasRegions;

struct PressureReport {
  int iterations = 0;
  double residual = 0.0;  // true residual over right-hand side, 2-norm, recomputed after the solve
};

// -sum over faces of transmissibility * (p_neighbour - p) + diagonal * p = right_hand_side, per
// cell. transmissibility[d] sits on the lower face of a cell in direction d (ghost face `size`
// filled) and is zero on closed faces; `diagonal` (>= 0) carries pressure outlets. A cell without
// any coefficient gets an identity row and p = 0.
struct PressureSystem {
  VectorField transmissibility;
  Field diagonal;
  Field right_hand_side;
  const GasRegions* regions = nullptr;  // of the transmissibilities, when the system is singular
};

class PressureSolver {
 public:
  virtual ~PressureSolver() = default;
  // Solves to |residual| <= tolerance * |right_hand_side|; `pressure` holds the first guess and
  // gets the solution with ghosts filled. A singular system (no diagonal anywhere in a connected
  // region) must come with a right-hand side whose mean was removed; the mean of p is then 0.
  virtual PressureReport solve(const PressureSystem& system, double tolerance, int max_iterations,
                               Field& pressure) = 0;
};

std::unique_ptr<PressureSolver> make_hypre_solver(const Decomposition& decomposition);
// Own conjugate gradients with a multigrid preconditioner: see pressure_multigrid.cpp.
std::unique_ptr<PressureSolver> make_multigrid_solver(const Decomposition& decomposition);

}  // namespace gasgrain::cfd
