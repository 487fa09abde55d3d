#include "coupling/run_results.hpp"

#include <algorithm>
#include <limits>

namespace gasgrain::coupling {

namespace {

std::string unit_of(const std::string& monitor) {
  if (monitor.starts_with("bed_height")) return "m";
  return monitor.starts_with("flux") ? "kg/s" : "-";
}

}  // namespace

BedMeans bed_means(const RunStatistics& statistics, const BedMonitor& monitor, double from) {
  BedMeans means;
  means.from = from;
  means.to = statistics.height.empty() ? from : statistics.height.back().time;
  means.height = batch_mean(statistics.height, from);
  means.pressure_drop = batch_mean(statistics.pressure_drop, from);
  const double weight = batch_mean(statistics.weight, from).value;
  means.weight_over_area = weight / monitor.cross_section();
  means.static_estimate =
      weight * means.height.value / open_volume_below(monitor.layers(), means.height.value);
  return means;
}

std::vector<NamedValue> series_values(const SeriesRow& row,
                                      const std::vector<std::string>& monitors, int axis) {
  const ExchangeReport& exchange = row.exchange;
  const MomentumBalance& balance = row.audit.balance;
  const double per_time = balance.interval > 0 ? 1.0 / balance.interval : 0.0;
  std::vector<NamedValue> values = {
      {"time", row.time},
      {"pressure_drop", row.bed.pressure_drop},
      {"bed_height", row.bed.height},
      {"weight_over_area", row.weight_over_area},
      {"momentum_residual", row.audit.momentum_residual},
      {"grain_momentum_rate", balance.grain_change[axis] * per_time},
      {"gas_momentum_rate", balance.gas_change[axis] * per_time},
      {"side_pressure_force", balance.side_pressure[axis] * per_time},
      {"grain_weight", balance.grain_weight[axis] * per_time},
      {"gas_weight", balance.gas_weight[axis] * per_time},
      {"walls_on_grains", balance.walls_on_grains[axis] * per_time},
      {"bodies_on_gas", balance.bodies_on_gas[axis] * per_time},
      {"walls_by_drag", balance.walls_by_drag[axis] * per_time},
      {"gas_through_sides", balance.gas_through_sides[axis] * per_time},
      {"in_transit", balance.in_transit[axis] * per_time},
      {"third_law_residual", exchange.third_law_residual},
      {"pressure_force_residual", exchange.pressure_residual},
      {"solid_volume_residual", exchange.solid_volume_residual},
      {"divergence", exchange.divergence},
      {"removed_mean", exchange.removed_mean},
      {"swept_imbalance", exchange.swept_imbalance},
      {"smallest_void_fraction", exchange.smallest_void_fraction},
      {"limited_closures", double(exchange.limited)},
      {"grains_inside", double(exchange.grains_inside)},
      {"grains_outside", double(exchange.grains_outside)},
      {"grain_passage", balance.passage[axis] * per_time},
      {"unexplained_grains", double(balance.unexplained_grains)},
      {"kinetic_energy", row.audit.energy.kinetic},
      {"rotation_energy", row.audit.energy.rotation},
      {"potential_energy", row.audit.energy.potential},
      {"elastic_energy", row.audit.energy.elastic},
      {"gas_power", row.audit.energy.gas_work * per_time},
      {"dissipation", row.audit.energy.dissipated * per_time},
      {"heating", row.audit.heating},
      {"largest_overlap", row.audit.overlap.length},
      {"largest_relative_overlap", row.audit.overlap.relative},
      {"interval", exchange.interval},
      {"gas_steps", double(exchange.gas_steps)},
      {"pressure_iterations", double(exchange.pressure_iterations)},
      {"pressure_fallbacks", double(exchange.pressure_fallbacks)}};
  for (std::size_t n = 0; n < monitors.size(); ++n)
    values.push_back({monitors[n], row.monitors.empty() ? 0.0 : row.monitors[n]});
  return values;
}

std::vector<Quantity> summary_quantities(const SeriesRow& row, const RunStatistics& statistics,
                                         const WallTimes& times, const BedMeans& means,
                                         const std::vector<std::string>& monitors) {
  const RunExtremes& extremes = statistics.extremes;
  const auto half_width = [](const TimeMean& mean) {
    return mean.half_width.value_or(std::numeric_limits<double>::quiet_NaN());
  };
  double rows_beyond = 0.0;
  for (const auto& [name, count] : statistics.violations) rows_beyond += double(count);
  const std::string batches = "95 % interval of ten batch means";
  std::vector<Quantity> quantities = {
      {"bed_height_mean",
       means.height.value,
       "m",
       {},
       {},
       "time mean of the level where the layer-averaged void fraction crosses 0.8"},
      {"bed_height_half_width", half_width(means.height), "m", {}, {}, batches},
      {"pressure_drop_mean", means.pressure_drop.value, "Pa", means.static_estimate, 0.05,
       "pressure_drop_force_balance"},
      {"pressure_drop_half_width", half_width(means.pressure_drop), "Pa", {}, {}, batches},
      {"pressure_drop_force_balance",
       means.static_estimate,
       "Pa",
       {},
       {},
       "weight x mean bed height / open volume below it"},
      {"pressure_drop_weight_over_area", means.weight_over_area, "Pa", {}, {}, "weight / area"},
      {"average_from", means.from, "s", {}, {}, "start of the time means"},
      {"average_to", means.to, "s", {}, {}, "end of the time means"},
      {"momentum_balance_residual", extremes.momentum_residual, "-", 0.0, 1e-6,
       "vertical balance of gas and grains over the weight, largest of all intervals"},
      {"third_law_residual", extremes.third_law_residual, "-", 0.0, 1e-12,
       "drag on grains against drag on gas, over the sum of magnitudes"},
      {"third_law_accumulated",
       extremes.drag_impulse > 0 ? extremes.unbalanced.norm() / extremes.drag_impulse : 0.0, "-",
       0.0, 1e-10, "the same, sums over all exchanges"},
      {"solid_volume_residual", extremes.solid_volume_residual, "-", 0.0, 1e-10,
       "solid volume in the cells against the grains'"},
      {"pressure_force_residual", extremes.pressure_residual, "-", 0.0, 1e-5,
       "-V grad p on grains against that of the gas, over the sum of magnitudes"},
      {"heating_max",
       extremes.heating,
       "-",
       {},
       {},
       "energy from nowhere in an interval over kinetic and elastic energy and weight x diameter"},
      {"gas_work", statistics.gas_work, "J", {}, {}, "of the gas on the grains, audited intervals"},
      {"dissipated_energy",
       statistics.dissipated,
       "J",
       {},
       {},
       "by contacts, and stored by springs at walls and tangential ones; less work of moving "
       "walls"},
      {"kinetic_energy", row.audit.energy.kinetic, "J", {}, {}, "of the grains, last row"},
      {"rotation_energy", row.audit.energy.rotation, "J", {}, {}, "of the grains, last row"},
      {"potential_energy",
       row.audit.energy.potential,
       "J",
       {},
       {},
       "of the grains' weight, last row"},
      {"elastic_energy",
       row.audit.energy.elastic,
       "J",
       {},
       {},
       "normal springs between grains, last row"},
      {"grains_appeared", double(statistics.appeared), "-", {}, {}, "inserted while the gas ran"},
      {"grains_left", double(statistics.left), "-", {}, {}, "left the box while the gas ran"},
      {"audit_violations", rows_beyond, "-", 0.0, 0.0, "rows beyond a bound of [coupling.audit]"},
      {"removed_mean_residual", extremes.removed_mean, "-", {}, {}, "of the pressure equation"},
      {"divergence_residual", extremes.divergence, "-", {}, {}, "largest of a cell, over its void"},
      {"overlap_max", extremes.overlap.relative, "-", {}, {}, "over the grain diameter"},
      {"overlap_max_length", extremes.overlap.length, "m", {}, {}, "the same as a length"},
      {"exchange_interval_max", extremes.longest_interval, "s", {}, {}, "between gas and grains"},
      {"time_dem", times.dem, "s", {}, {}, "wall time, mean over ranks"},
      {"time_coupling", times.coupling, "s", {}, {}, "wall time, mean over ranks"},
      {"time_gas", times.gas, "s", {}, {}, "wall time, mean over ranks"},
      {"grain_steps_per_second",
       statistics.grain_steps / std::max(times.total(), 1e-30),
       "1/s",
       {},
       {},
       "all wall time"}};
  for (std::size_t n = 0; n < monitors.size() && n < statistics.monitors.size(); ++n) {
    quantities.push_back({monitors[n] + "_mean",
                          batch_mean(statistics.monitors[n], means.from).value,
                          unit_of(monitors[n]),
                          {},
                          {},
                          "time mean of the rows of timeseries.csv"});
  }
  return quantities;
}

}  // namespace gasgrain::coupling
