// The bed as horizontal layers of gas cells, and what a height can mean.
#pragma once

#include <cstddef>
#include <vector>

namespace gasgrain::coupling {

// Layers from below, one per cell along the vertical.
struct BedLayers {
  double thickness = 0.0;             // m
  double cell_volume = 0.0;           // m^3
  std::vector<double> open_cells;     // what bodies leave open, in cell volumes
  std::vector<double> void_fraction;  // mean over the open part, in [0, 1]; 1 where nothing is open

  std::size_t count() const { return open_cells.size(); }
  double middle(std::size_t layer) const { return (double(layer) + 0.5) * thickness; }  // m
  double solid_cells(std::size_t layer) const {
    return open_cells[layer] * (1.0 - void_fraction[layer]);
  }
};

// Highest level, in m above the lower end of the grid, at which the void fraction crosses
// `threshold`, linearly between the middles of layers that are open; 0 for an empty grid, the upper
// end when the highest open layer is below the threshold.
double level_of_void_fraction(const BedLayers& layers, double threshold);
// Level below which `share` of the solid volume lies, in m; 0 for an empty grid.
double level_of_solid_share(const BedLayers& layers, double share);
// Mean height of the solid volume, m.
double centre_of_solid(const BedLayers& layers);
// Volume that bodies leave open below `height`, m^3.
double open_volume_below(const BedLayers& layers, double height);

}  // namespace gasgrain::coupling
