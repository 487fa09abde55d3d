// div( a c grad p ) = right-hand side on the cells of the grid: the pressure equation.
#pragma once

#include <memory>

#include "cfd/field.hpp"
#include "cfd/grid.hpp"
#include "cfd/pressure_method.hpp"

namespace gasgrain::cfd {

struct GasRegions;

struct PressureReport {
  int iterations = 0;     // of all methods that were tried
  double residual = 0.0;  // true residual over right-hand side, 2-norm, recomputed after the solve
  bool converged = true;  // within the tolerance, or nothing but round-off is left of the residual
  int fallbacks = 0;      // 1 when the chosen method missed the tolerance and another one solved
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
  // region) must come with a right-hand side whose mean was removed; the constant of p is then
  // arbitrary. Collective.
  virtual PressureReport solve(const PressureSystem& system, double tolerance, int max_iterations,
                               Field& pressure) = 0;
};

// One method on its own; its report's `converged` only compares with the tolerance.
std::unique_ptr<PressureSolver> make_pressure_solver(const Decomposition& decomposition,
                                                     PressureMethod method);

// The chosen method, watched: a solve that misses its tolerance is repeated from the same first
// guess by `fallback`, which may take `fallback_iterations`. See pressure_fallback.cpp.
inline constexpr int fallback_iterations = 500;
std::unique_ptr<PressureSolver> make_pressure_solver(const Decomposition& decomposition,
                                                     PressureMethod method,
                                                     PressureFallback fallback);

}  // namespace gasgrain::cfd
