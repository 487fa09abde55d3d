// Bubbles: connected voids inside a bed.
#pragma once

#include "cfd/gas_solver.hpp"
#include "coupling/bed_monitor.hpp"

namespace gasgrain::coupling {

struct Bubbles {
  int count = 0;
  double volume = 0.0;  // m^3, open volume of the cells
};

struct BedCells {
  const cfd::Field& open_fraction;  // as in Deposition
  const cfd::Field& void_fraction;
};

struct BubbleLimits {
  double void_fraction;  // cells above it are void
  double surface;        // of the bed, m above the lower end of the grid
};

// Groups of void cells that share open faces, hold at least 2 x 2 x 2 cells (2 x 2 in a grid one
// cell deep) and do not reach the surface: those belong to the freeboard. Collective.
Bubbles find_bubbles(const cfd::GasSolver& gas, const BedCells& bed, const Vertical& vertical,
                     const BubbleLimits& limits);

}  // namespace gasgrain::coupling
