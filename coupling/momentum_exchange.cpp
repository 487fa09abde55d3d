#include "coupling/momentum_exchange.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gasgrain::coupling {

double exchange_coefficient(const GrainRecord& grain, const SurroundingGas& gas,
                            const DragOptions& options) {
  const DragInput input{
      .void_fraction = std::clamp(gas.void_fraction, options.smallest_void_fraction, 1.0),
      .diameter = grain.original_diameter,
      .slip = (gas.velocity - grain.velocity).norm(),
      .density = options.density,
      .viscosity = options.viscosity};
  if (options.mixture)
    return drag_in_mixture(options.closure, input, gas.sauter_diameter) * grain.volume;
  return options.closure(input) * grain.volume;
}

bool void_fraction_is_limited(const SurroundingGas& gas, const DragOptions& options) {
  // Round-off above one is no limitation.
  return gas.void_fraction < options.smallest_void_fraction || gas.void_fraction > 1.0 + 1e-9;
}

double stable_exchange_interval(const GrainRecord& grain, double void_fraction,
                                double exchange_coefficient) {
  if (exchange_coefficient <= 0) return std::numeric_limits<double>::infinity();
  return 2.0 * void_fraction * void_fraction * grain.mass / exchange_coefficient;
}

}  // namespace gasgrain::coupling
