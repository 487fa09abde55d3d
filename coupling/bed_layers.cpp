#include "coupling/bed_layers.hpp"

#include <algorithm>

namespace gasgrain::coupling {

double level_of_void_fraction(const BedLayers& layers, double threshold) {
  double above = 1.0;  // void fraction of the next open layer above
  std::size_t layer_above = layers.count();
  for (std::size_t layer = layers.count(); layer-- > 0;) {
    if (layers.open_cells[layer] <= 0) continue;
    const double mean = layers.void_fraction[layer];
    if (mean < threshold) {
      if (layer_above == layers.count()) return double(layer_above) * layers.thickness;
      const double share = (threshold - mean) / (above - mean);
      return (double(layer) + 0.5 + share * double(layer_above - layer)) * layers.thickness;
    }
    above = mean;
    layer_above = layer;
  }
  return 0.0;
}

double level_of_solid_share(const BedLayers& layers, double share) {
  double total = 0.0;
  for (std::size_t layer = 0; layer < layers.count(); ++layer) total += layers.solid_cells(layer);
  double rest = share * total;
  for (std::size_t layer = 0; layer < layers.count(); ++layer) {
    const double solid = layers.solid_cells(layer);
    if (solid > 0 && rest <= solid) return (double(layer) + rest / solid) * layers.thickness;
    rest -= solid;
  }
  return total > 0 ? double(layers.count()) * layers.thickness : 0.0;
}

double centre_of_solid(const BedLayers& layers) {
  double moment = 0.0, total = 0.0;
  for (std::size_t layer = 0; layer < layers.count(); ++layer) {
    moment += layers.solid_cells(layer) * layers.middle(layer);
    total += layers.solid_cells(layer);
  }
  return total > 0 ? moment / total : 0.0;
}

double open_volume_below(const BedLayers& layers, double height) {
  double cells = 0.0;
  for (std::size_t layer = 0; layer < layers.count(); ++layer) {
    cells +=
        layers.open_cells[layer] * std::clamp(height / layers.thickness - double(layer), 0.0, 1.0);
  }
  return cells * layers.cell_volume;
}

}  // namespace gasgrain::coupling
