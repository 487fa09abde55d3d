#include "coupling/run_report.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "coupling/shared/text.hpp"

namespace gasgrain::coupling {

namespace {

std::string percent_shares(const WallTimes& times) {
  const double percent = 100.0 / std::max(times.total(), 1e-30);
  return text("DEM %.0f %%, coupling %.0f %%, gas %.0f %%", times.dem * percent,
              times.coupling * percent, times.gas * percent);
}

std::string unit_of(const std::string& monitor) {
  if (monitor.starts_with("bed_height")) return "m";
  return monitor.starts_with("flux") ? "kg/s" : "-";
}

std::string with_interval(const TimeMean& mean, double scale, const char* unit) {
  if (std::isnan(mean.value)) return "not reached: the run ended before coupling.average_from";
  std::string result = text("%.4g", mean.value * scale);
  if (mean.half_width) result += text(" +- %.2g", *mean.half_width * scale);
  return result + " " + unit + (mean.half_width ? " (95 % of batch means)" : "");
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

std::string scene_text(const Scene& scene) {
  const cfd::Grid& grid = scene.gas.grid;
  const Vec3 spacing = grid.spacing() * 1e3;
  const SmoothingPlan& plan = scene.coupling.deposition().plan();
  const IntervalLimits& limits = scene.report.limits;
  const GrainSizes& sizes = scene.sizes;
  std::string out = "\nGas and grains (fix couple/gas)\n";
  out += text("  grid           %d x %d x %d cells of %.4g x %.4g x %.4g mm\n", grid.cells[0],
              grid.cells[1], grid.cells[2], spacing[0], spacing[1], spacing[2]);
  out += text("  gas            %.4g kg/m^3, %.4g Pa s, %.4g %.4g %.4g m/s^2\n",
              scene.gas.gas.density, scene.gas.gas.viscosity, scene.gas.gas.gravity[0],
              scene.gas.gas.gravity[1], scene.gas.gas.gravity[2]);
  out += text("  grains         %ld in the grid, %ld outside (no gas force there)\n",
              scene.report.grains_inside, scene.report.grains_outside);
  if (sizes.largest_diameter > 0) {
    out += text("  diameter       %.4g to %.4g mm, of the original particles %.4g to %.4g mm\n",
                sizes.smallest_diameter * 1e3, sizes.largest_diameter * 1e3,
                sizes.smallest_original * 1e3, sizes.largest_original * 1e3);
    out += text("  grain ratio l  %.4g to %.4g; %.3g cells per largest grain diameter\n",
                sizes.smallest_diameter / sizes.smallest_original,
                sizes.largest_diameter / sizes.largest_original,
                sizes.largest_diameter * 1e3 / spacing.maxCoeff());
  }
  out += text("  drag           %s on the original diameter, %s\n", scene.options.drag_name.c_str(),
              scene.options.feedback == Feedback::two_way ? "two-way" : "one-way");
  if (scene.options.mapping != Mapping::spline)
    out += text("  mapping        %s\n", mapping_name(scene.options.mapping).c_str());
  out += text("  kernel         standard deviation %.4g mm, %d smoothing sweeps\n",
              scene.coupling.kernel_width() * 1e3, plan.sweeps);
  out += text("  exchange       every %d DEM steps of %.4g s = %.4g s, limited by %s\n",
              scene.interval.dem_steps, scene.dem_step, scene.interval.dem_steps * scene.dem_step,
              scene.interval.limited_by.c_str());
  out += text(
      "  limits         grain motion %.3g s, drag (5 %% of its stability limit) %.3g s, gas "
      "%.3g s\n",
      limits.grain_motion, 0.05 * limits.exchange, limits.gas);
  for (const std::string& wall : scene.unmeasured_walls) {
    out += text(
        "  note           nobody measures the force of wall fix %s: it will show as "
        "residual of the momentum balance\n",
        wall.c_str());
  }
  if (!scene.gas.gas.gravity.isZero() && !scene.gas.gas.gravity.isApprox(scene.gravity, 1e-6)) {
    out += text(
        "  note           gravity of the gas differs from that of the grains, "
        "%.6g %.6g %.6g m/s^2\n",
        scene.gravity[0], scene.gravity[1], scene.gravity[2]);
  }
  out += "  files          " + (scene.directory.empty() ? "none" : scene.directory) + "\n\n";
  return out;
}

std::string progress_text(const SeriesRow& row, const WallTimes& times, const RunProgress& progress,
                          const Pace& pace) {
  const double share = progress.total > 0 ? double(progress.done) / double(progress.total) : 1.0;
  const double remaining =
      pace.steps > 0 ? pace.seconds * double(progress.total - progress.done) / double(pace.steps)
                     : std::numeric_limits<double>::infinity();
  std::string out =
      text("t %.4f s  %3.0f %%  %s left | dp %.1f Pa  bed %.2f mm  overlap %.2g %% | ", row.time,
           100 * share, duration(remaining).c_str(), row.bed.pressure_drop, row.bed.height * 1e3,
           100 * row.audit.overlap.relative);
  out += percent_shares(times);
  if (row.exchange.grains_outside > 0) {
    out += text(" | %ld grains outside the gas grid", row.exchange.grains_outside);
  }
  if (row.exchange.limited > 0) {
    out += text(" | void fraction limited for %ld grains", row.exchange.limited);
  }
  return out + "\n";
}

std::string closing_text(const SeriesRow& row, const RunStatistics& statistics,
                         const WallTimes& times, const BedMeans& means) {
  const RunExtremes& extremes = statistics.extremes;
  std::string out = "\nGas and grains: result\n";
  out += text(
      "  simulated            %.4f s of gas in %ld exchanges of %.3g to %.3g s, %ld gas steps, "
      "%.3g pressure iterations each\n",
      row.time, extremes.exchanges, extremes.shortest_interval, extremes.longest_interval,
      extremes.gas_steps,
      double(extremes.pressure_iterations) / double(std::max(extremes.gas_steps, 1L)));
  out += text("  averaged             from %.4g to %.4g s\n", means.from, means.to);
  out += "  bed height           " + with_interval(means.height, 1e3, "mm") + "\n";
  out += "  pressure drop        " + with_interval(means.pressure_drop, 1.0, "Pa") + "\n";
  if (!std::isnan(means.pressure_drop.value) && means.weight_over_area > 0) {
    out += text("    weight over area   %.4g Pa; measured is %.4g times that\n",
                means.weight_over_area, means.pressure_drop.value / means.weight_over_area);
    out += text(
        "    with bodies        %.4g Pa (weight over the open volume below the bed height "
        "times height); measured is %.4g times that\n",
        means.static_estimate, means.pressure_drop.value / means.static_estimate);
  }
  out += text("  vertical momentum    largest residual %.2g of the weight\n",
              extremes.momentum_residual);
  out += text("  gas-grain exchange   drag residual %.2g, pressure force residual %.2g\n",
              extremes.third_law_residual, extremes.pressure_residual);
  out +=
      text("  solid volume         largest residual %.2g; smallest void fraction of a cell %.3g\n",
           extremes.solid_volume_residual, extremes.smallest_void_fraction);
  out += text("  continuity           largest divergence %.2g, removed mean %.2g\n",
              extremes.divergence, extremes.removed_mean);
  if (extremes.pressure_fallbacks > 0) {
    out += text("  pressure fallback    took over in %ld gas steps\n", extremes.pressure_fallbacks);
  }
  out += text("  largest overlap      %.3g um, %.3g %% of the grain diameter\n",
              extremes.overlap.length * 1e6, 100 * extremes.overlap.relative);
  out += text("  energy               gas did %.3g J on the grains, %.3g J dissipated",
              statistics.gas_work, statistics.dissipated);
  out += extremes.heating > 0
             ? text("; most from nowhere %.2g of kinetic, elastic and lifting energy\n",
                    extremes.heating)
             : "\n";
  if (statistics.appeared + statistics.left > 0) {
    out += text("  grains               %ld inserted, %ld left the box\n", statistics.appeared,
                statistics.left);
  }
  for (const auto& [name, count] : statistics.violations) {
    if (count > 0) {
      out += text("  audit                %s beyond its bound in %ld rows\n", name.c_str(), count);
    }
  }
  out += text("  closure limited      %ld times; at most %ld grains outside the gas grid\n",
              extremes.limited, extremes.grains_outside);
  out += text("  wall time            %s: %s (%.3g + %.3g + %.3g s)\n",
              duration(times.total()).c_str(), percent_shares(times).c_str(), times.dem,
              times.coupling, times.gas);
  out += text("  speed                %.4g grain-steps per second\n\n",
              statistics.grain_steps / std::max(times.total(), 1e-30));
  return out;
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
