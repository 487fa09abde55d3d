// What pressure_hypre.cpp asks of a solver of hypre.
#pragma once

#include <memory>

#include "cfd/field.hpp"
#include "cfd/grid.hpp"
#include "cfd/pressure_method.hpp"

namespace gasgrain::cfd {

// The symmetric matrix: the whole diagonal of every owned cell, pinned where the system is
// singular, and minus the off-diagonals, which sit on the lower faces (ghost face `size` filled).
struct HypreMatrix {
  const VectorField& transmissibility;
  const Field& diagonal;
};

class HypreBackend {
 public:
  virtual ~HypreBackend() = default;
  // Collective. `pattern_changed`: other off-diagonals than before are zero.
  virtual void set_matrix(const HypreMatrix& matrix, bool pattern_changed) = 0;
  // Preconditioned conjugate gradients from the guess in `solution`, until the recursive residual
  // is at most tolerance * |right_hand_side|. Returns the number of iterations. Collective.
  virtual int solve(Field& solution, const Field& right_hand_side, double tolerance,
                    int max_iterations) = 0;
};

// PFMG and SMG: the structured-grid interface.
std::unique_ptr<HypreBackend> make_hypre_struct(const Decomposition& decomposition,
                                                PressureMethod method);
std::unique_ptr<HypreBackend> make_hypre_boomeramg(const Decomposition& decomposition);

void initialize_hypre_once();

}  // namespace gasgrain::cfd
