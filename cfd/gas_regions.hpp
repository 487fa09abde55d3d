// Connected regions of gas: cells joined by faces through which gas can move.
#pragma once

#include <vector>

#include "cfd/field.hpp"
#include "cfd/grid.hpp"

namespace gasgrain::cfd {

struct GasRegion {
  bool has_outlet = false;  // some cell carries a pressure boundary
  double cells = 0.0;       // number of cells, all ranks
  Index3 first_cell{};      // global index of the region's cell with the smallest number
};

struct GasRegions {
  static constexpr int none = -1;

  std::vector<GasRegion> regions;   // the same list on every rank, ordered by first_cell
  std::vector<int> region_of_cell;  // owned cells, x fastest; `none` where no face is joined

  bool any_singular() const;  // some region has no outlet
};

// Flood fill over all ranks. `joined` is positive on faces (ghosts filled) that gas can cross;
// `outlet` is positive in cells next to a pressure boundary. Collective.
GasRegions find_gas_regions(const Decomposition& decomposition, const VectorField& joined,
                            const Field& outlet);

// sums[r] = sum of `values` (owned cells) over region r, all ranks. Collective.
void sum_per_region(std::vector<double>& sums, const Decomposition& decomposition,
                    const GasRegions& regions, const Field& values);

std::vector<double> sum_per_region(const Decomposition& decomposition, const GasRegions& regions,
                                   const Field& values);

// values -= amounts[r] in the owned cells of region r.
void subtract_per_region(Field& values, const GasRegions& regions,
                         const std::vector<double>& amounts);

// Sums per region over all ranks divided by the number of cells in regions without outlet, 0 in the
// others: what is to be subtracted to leave no mean there.
void means_of_singular_regions(std::vector<double>& means, const Decomposition& decomposition,
                               const GasRegions& regions, const Field& values);

}  // namespace gasgrain::cfd
