// A bed of grains at rest: the grain phase of the stand-alone solver's [fixed_bed] section.
#pragma once

#include "cfd/gas_solver.hpp"
#include "coupling/shared/drag.hpp"

namespace gasgrain::cfd {

class FixedBedDrag {
 public:
  // Puts the bed's void fraction into the solver; a cell that the box covers in part gets its
  // share.
  FixedBedDrag(GasSolver& solver);

  // Sets the momentum exchange for the solver's present velocity. Collective.
  void update(GasSolver& solver) const;

 private:
  DragClosure closure_;
  Field solid_;  // solid volume over open volume, cells
};

}  // namespace gasgrain::cfd
