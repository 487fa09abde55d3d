#include "coupling/run_statistics.hpp"

#include <algorithm>

namespace gasgrain::coupling {

void RunExtremes::note(const ExchangeReport& report) {
  shortest_interval =
      exchanges == 0 ? report.interval : std::min(shortest_interval, report.interval);
  longest_interval = std::max(longest_interval, report.interval);
  ++exchanges;
  gas_steps += report.gas_steps;
  pressure_iterations += report.pressure_iterations;
  pressure_fallbacks += report.pressure_fallbacks;
  limited += report.limited;
  grains_outside = std::max(grains_outside, report.grains_outside);
  third_law_residual = std::max(third_law_residual, report.third_law_residual);
  pressure_residual = std::max(pressure_residual, report.pressure_residual);
  solid_volume_residual = std::max(solid_volume_residual, report.solid_volume_residual);
  divergence = std::max(divergence, report.divergence);
  removed_mean = std::max(removed_mean, report.removed_mean);
  smallest_void_fraction = std::min(smallest_void_fraction, report.smallest_void_fraction);
}

void RunStatistics::note(const BedState& bed, const ExchangeReport& report) {
  extremes.note(report);
  height.push_back({bed.time, report.interval, bed.height});
  pressure_drop.push_back({bed.time, report.interval, bed.pressure_drop});
  weight.push_back({bed.time, report.interval, bed.weight});
}

}  // namespace gasgrain::coupling
