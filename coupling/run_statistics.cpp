#include "coupling/run_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "coupling/audit_bounds.hpp"

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
  unbalanced += report.unbalanced;
  drag_impulse += report.drag_impulse;
  pressure_residual = std::max(pressure_residual, report.pressure_residual);
  solid_volume_residual = std::max(solid_volume_residual, report.solid_volume_residual);
  divergence = std::max(divergence, report.divergence);
  removed_mean = std::max(removed_mean, report.removed_mean);
  smallest_void_fraction = std::min(smallest_void_fraction, report.smallest_void_fraction);
}

namespace {

void visit(cfd::StateArchive& archive, const std::string& name, std::vector<TimedSample>& samples) {
  std::vector<double> columns[3];
  for (const TimedSample& sample : samples) {
    columns[0].push_back(sample.time);
    columns[1].push_back(sample.interval);
    columns[2].push_back(sample.value);
  }
  const char* names[] = {"_time", "_interval", "_value"};
  for (int c = 0; c < 3; ++c) archive.list(name + names[c], columns[c]);
  if (!archive.restores()) return;
  samples.clear();
  for (std::size_t n = 0; n < columns[0].size(); ++n)
    samples.push_back({columns[0][n], columns[1][n], columns[2][n]});
}

void visit(cfd::StateArchive& archive, RunExtremes& e) {
  archive.number_of("exchanges", e.exchanges);
  archive.number_of("gas_steps", e.gas_steps);
  archive.number_of("pressure_iterations", e.pressure_iterations);
  archive.number_of("limited", e.limited);
  archive.number_of("grains_outside", e.grains_outside);
  archive.number("shortest_interval", e.shortest_interval);
  archive.number("longest_interval", e.longest_interval);
  archive.number("third_law_residual", e.third_law_residual);
  for (int d = 0; d < 3; ++d)
    archive.number(std::string("unbalanced_") + "xyz"[d], e.unbalanced[d]);
  archive.number("drag_impulse", e.drag_impulse);
  archive.number("pressure_residual", e.pressure_residual);
  archive.number("solid_volume_residual", e.solid_volume_residual);
  archive.number("divergence", e.divergence);
  archive.number("removed_mean", e.removed_mean);
  archive.number("momentum_residual", e.momentum_residual);
  archive.number("heating", e.heating);
  archive.number("largest_overlap", e.overlap.length);
  archive.number("largest_relative_overlap", e.overlap.relative);
  archive.number("smallest_void_fraction", e.smallest_void_fraction);
}

}  // namespace

void RunStatistics::visit_state(cfd::StateArchive& archive) {
  visit(archive, extremes);
  visit(archive, "height", height);
  visit(archive, "pressure_drop", pressure_drop);
  visit(archive, "weight", weight);
  double kinds = double(monitors.size());
  archive.number("monitors", kinds);
  monitors.resize(static_cast<std::size_t>(kinds));
  for (std::size_t n = 0; n < monitors.size(); ++n)
    visit(archive, "monitor_" + std::to_string(n), monitors[n]);
  archive.number("total_gas_work", gas_work);
  archive.number("total_dissipated", dissipated);
  archive.number_of("grains_appeared", appeared);
  archive.number_of("grains_left", left);
  for (const char* name : bound_names)
    archive.number_of(std::string("violations_") + name, violations[name]);
  archive.number("grain_steps", grain_steps);
}

void RunStatistics::note(const BedState& bed, const ExchangeReport& report) {
  extremes.note(report);
  height.push_back({bed.time, report.interval, bed.height});
  pressure_drop.push_back({bed.time, report.interval, bed.pressure_drop});
  weight.push_back({bed.time, report.interval, bed.weight});
}

void RunStatistics::note_audit(const AuditRow& row) {
  extremes.overlap.length = std::max(extremes.overlap.length, row.overlap.length);
  extremes.overlap.relative = std::max(extremes.overlap.relative, row.overlap.relative);
  extremes.momentum_residual =
      std::max(extremes.momentum_residual, std::abs(row.momentum_residual));
  extremes.heating = std::max(extremes.heating, row.heating);
  gas_work += row.energy.gas_work;
  dissipated += row.energy.dissipated;
  appeared += row.traffic.appeared;
  left += row.traffic.left;
}

void RunStatistics::note_monitors(double time, double interval, const std::vector<double>& values) {
  monitors.resize(values.size());
  for (std::size_t n = 0; n < values.size(); ++n)
    monitors[n].push_back({time, interval, values[n]});
}

}  // namespace gasgrain::coupling
