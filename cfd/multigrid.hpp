// One multigrid V-cycle for the pressure equation, in single precision: the preconditioner of
// pressure_multigrid.cpp.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "cfd/field.hpp"
#include "cfd/grid.hpp"
#include "cfd/pressure_solver.hpp"

namespace gasgrain::cfd {

struct MultigridLevel;

class Multigrid {
 public:
  // Collective. Plans the levels; they depend on the grid and its blocks only.
  explicit Multigrid(const Decomposition& decomposition);
  ~Multigrid();

  // Collective. Takes the coefficients of `system` (ghost faces filled) to all levels.
  void set_coefficients(const PressureSystem& system);

  // Collective. result = M^-1 (scale * residual) / scale on owned cells, with M symmetric positive
  // definite up to the null space; `scale` brings the residual into the range of single precision.
  void apply(const Field& residual, double scale, Field& result);

 private:
  struct Coarsest;

  void factor_coarsest();
  void cycle(std::size_t level);

  const Decomposition& decomposition_;
  std::vector<std::unique_ptr<MultigridLevel>> levels_;
  std::unique_ptr<Coarsest> coarsest_;
};

}  // namespace gasgrain::cfd
