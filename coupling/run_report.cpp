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

std::string with_interval(const TimeMean& mean, double scale, const char* unit) {
  if (std::isnan(mean.value)) return "not reached: the run ended before coupling.average_from";
  std::string result = text("%.4g", mean.value * scale);
  if (mean.half_width) result += text(" +- %.2g", *mean.half_width * scale);
  return result + " " + unit + (mean.half_width ? " (95 % of batch means)" : "");
}

}  // namespace

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

}  // namespace gasgrain::coupling
