#include "liggghts_plugins/grain_size_error.hpp"

namespace gasgrain::plugins {

GrainSizeError grain_size_error(double gap, double original, double ratio) {
  constexpr double slot = 6.0, layer = 0.9;
  const double grain = ratio * original;
  const double across = gap / grain;
  return {.slot_rate = (1.0 + slot * original / gap) / (1.0 + slot * grain / gap) - 1.0,
          .layer = layer * (grain - original) / gap,
          .measured = across >= 4.0 && across <= 20.0};
}

}  // namespace gasgrain::plugins
