#include "cfd/run_display.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "cfd/halo_exchange.hpp"
#include "cfd/side_states.hpp"
#include "coupling/files/collective_error.hpp"
#include "coupling/files/summary.hpp"
#include "coupling/shared/text.hpp"

namespace gasgrain::cfd {

namespace {

constexpr const char* program = "gasgrain-gas";

std::string bodies_text(const GasCase& gas_case, double closed_share) {
  std::string names;
  for (const Body& body : gas_case.bodies) names += (names.empty() ? "" : ", ") + body.name;
  if (names.empty()) return "none";
  return names + text("; they fill %.3g %% of the grid", 100.0 * closed_share);
}

std::string files_text(const GasCase& gas_case) {
  const Output& output = gas_case.output;
  if (output.directory.empty()) return "none (give output.directory or --out to get some)";
  std::string result = output.directory + ": gas.csv every step, fields ";
  result += output.interval > 0.0 ? text("every %.4g s", output.interval) : "at the end";
  if (gas_case.run.checkpoint_interval > 0.0) {
    result += text(", checkpoints every %.4g s", gas_case.run.checkpoint_interval);
  }
  return result;
}

// Share of the grid inside bodies.
double closed_share(const GasSolver& solver) {
  const Decomposition& decomposition = solver.decomposition();
  const Index3& cells = decomposition.grid().cells;
  const Field& wall = solver.walls().wall_fraction;
  double sum = 0.0;
  for (int k = 0; k < wall.size()[2]; ++k)
    for (int j = 0; j < wall.size()[1]; ++j)
      for (int i = 0; i < wall.size()[0]; ++i) sum += wall(i, j, k);
  return sum_over_ranks(decomposition, sum) / (double(cells[0]) * cells[1] * cells[2]);
}

double total(const StepTimes& t) {
  return t.predictor + t.boundary + t.pressure + t.correction;
}

std::string shares(const StepTimes& t, double elapsed) {
  const double percent = 100.0 / std::max(elapsed, 1e-30);
  return text(
      "predictor %.0f %%, boundaries %.0f %%, pressure %.0f %%, correction %.0f %%, rest "
      "and files %.0f %%",
      t.predictor * percent, t.boundary * percent, t.pressure * percent, t.correction * percent,
      std::max(elapsed - total(t), 0.0) * percent);
}

}  // namespace

RunDisplay::RunDisplay(const GasSolver& solver, double end_time)
    : solver_(solver), talks_(solver.decomposition().rank() == 0), end_time_(end_time) {}

void RunDisplay::start(const GasCase& gas_case, const std::vector<std::string>& notes) {
  started_at_ = MPI_Wtime();
  start_time_ = solver_.time();
  const double closed = closed_share(solver_);
  if (!talks_) return;
  const Decomposition& blocks = solver_.decomposition();
  const Index3 &n = blocks.grid().cells, &ranks = blocks.ranks();
  const Vec3 h = blocks.grid().spacing() * 1e3;
  std::printf("%s\n", program);
  std::printf("  grid      %d x %d x %d cells of %.4g x %.4g x %.4g mm on %d rank%s\n", n[0], n[1],
              n[2], h[0], h[1], h[2], blocks.size(), blocks.size() == 1 ? "" : "s");
  if (blocks.size() > 1) {
    std::printf("            (%d x %d x %d blocks)\n", ranks[0], ranks[1], ranks[2]);
  }
  std::printf("  gas       %.4g kg/m^3, %.4g Pa s\n", gas_case.gas.density, gas_case.gas.viscosity);
  std::printf("  bodies    %s\n", bodies_text(gas_case, closed).c_str());
  print_patches();
  if (gas_case.fixed_bed.present) {
    std::printf("  bed       void fraction %.4g of particles of %.4g mm, drag %s\n",
                gas_case.fixed_bed.void_fraction, gas_case.fixed_bed.diameter * 1e3,
                gas_case.fixed_bed.drag.c_str());
  }
  std::printf("  run       from %.6g to %.6g s, steps %s\n", start_time_, end_time_,
              gas_case.run.step > 0.0 ? text("of %.4g s", gas_case.run.step).c_str()
                                      : "as large as stable");
  std::printf("  files     %s\n", files_text(gas_case).c_str());
  for (const std::string& note : notes) std::printf("  %s\n", note.c_str());
  std::printf("\n%12s %5s %11s %8s %6s %10s %12s %14s\n", "time/s", "done", "step/s", "Courant",
              "iter", "residual", "u_max/(m/s)", "time left");
  std::fflush(stdout);
}

void RunDisplay::print_patches() const {
  const Grid& grid = solver_.decomposition().grid();
  for (const SidePart& part : solver_.side_parts()) {
    if (part.name.empty()) continue;
    std::printf("  patch     '%s' on %s: %ld faces, %.6g m^2\n", part.name.c_str(),
                names_of_sides[part.direction][part.side], part.faces,
                double(part.faces) * grid.cell_volume() / grid.spacing()[part.direction]);
  }
}

void RunDisplay::count(const StepReport& report) {
  const auto wall = [&](Pass pass) { return report.times[static_cast<std::size_t>(pass)].wall; };
  times_.predictor += wall(Pass::slope) + wall(Pass::medium) + wall(Pass::predict);
  times_.boundary += wall(Pass::boundary);
  times_.pressure += wall(Pass::equation) + wall(Pass::solve);
  times_.correction += wall(Pass::correct) + wall(Pass::budget);
}

void RunDisplay::progress(const StepReport& report, double dt) const {
  if (!talks_) return;
  const double share = (solver_.time() - start_time_) / (end_time_ - start_time_);
  std::printf("%12.5e %3.0f %% %11.3e %8.3f %6d %10.1e %12.4e %14s\n", solver_.time(),
              100.0 * solver_.time() / end_time_, dt, report.courant_number,
              report.pressure.iterations, report.pressure.residual, report.largest_speed,
              duration(elapsed() * (1.0 - share) / share).c_str());
  std::fflush(stdout);
}

void RunDisplay::stopped(const std::string& checkpoint, long steps) const {
  if (!talks_) return;
  std::printf("\nstopped by a signal at %.6g s, step %ld\n", solver_.time(), steps);
  if (checkpoint.empty()) {
    std::printf("  nothing was saved: there is no output.directory\n");
  } else {
    std::printf("  state in %s\n  continue with the same command and --restart latest\n",
                checkpoint.c_str());
  }
  std::fflush(stdout);
}

void RunDisplay::finish(const StepReport& report, const RunCounters& counters,
                        const GasCase& gas_case) const {
  const std::vector<SideState> sides = side_states(solver_);
  const StepTimes times = mean_times();
  const double wall = elapsed();
  const double steps = static_cast<double>(std::max(counters.steps, 1L));
  std::vector<Quantity> quantities{
      {"end_time", solver_.time(), "s", {}, {}, "simulated"},
      {"steps", double(counters.steps), "-", {}, {}, "since the start of the case"},
      {"pressure_iterations", double(counters.iterations) / steps, "-", {}, {}, "mean of a step"},
      {"viscous_iterations",
       double(counters.viscous_iterations) / steps,
       "-",
       {},
       {},
       "of implicit viscosity, mean of a step"},
      {"pressure_fallbacks", double(counters.fallbacks), "-", {}, {}, "steps that needed it"},
      {"largest_speed", report.largest_speed, "m/s", {}, {}, "at the end"},
      {"largest_divergence", counters.largest_divergence, "-", {}, {}, "of a cell's gas"},
      {"largest_removed_mean", counters.largest_removed_mean, "-", {}, {}, "of sealed regions"},
      {"shortened_steps", double(counters.shortened), "-", {}, {}, "below run.step for stability"},
      {"largest_backflow", counters.largest_backflow, "m^3/s", {}, {}, "in through outlets"},
      {"wall_time", wall, "s", {}, {}, "since the start or restart"},
      {"wall_time_predictor", times.predictor, "s", {}, {}, "mean of the ranks"},
      {"wall_time_boundary", times.boundary, "s", {}, {}, "mean of the ranks"},
      {"wall_time_pressure", times.pressure, "s", {}, {}, "mean of the ranks"},
      {"wall_time_correction", times.correction, "s", {}, {}, "mean of the ranks"}};
  if (solver_.has_motion()) {
    quantities.push_back({"largest_swept_imbalance",
                          counters.largest_swept_imbalance,
                          "-",
                          {},
                          {},
                          "of sealed regions with moving bodies"});
  }
  if (talks_) std::printf("\nresult at %.6g s\n", solver_.time());
  for (const SideState& side : sides) {
    if (!side.periodic) {
      quantities.push_back({side.name + "_pressure", side.pressure, "Pa", {}, {}, "at the end"});
    }
    quantities.push_back({side.name + "_flux", side.flux, "m^3/s", {}, {}, "at the end"});
    if (!talks_) continue;
    std::printf("  %s  %s  flux %13.6e m^3/s\n", side.name.c_str(),
                side.periodic ? "periodic                 "
                              : text("pressure %13.6e Pa", side.pressure).c_str(),
                side.flux);
  }
  if (talks_) {
    std::printf("  largest velocity      %.5e m/s\n", report.largest_speed);
    std::printf("  largest divergence    %.2e of a cell's gas in a step\n",
                counters.largest_divergence);
    std::printf("  largest removed mean  %.2e\n", counters.largest_removed_mean);
    if (solver_.has_motion()) {
      std::printf("  swept imbalance       up to %.2e of what bodies displace, evened out\n",
                  counters.largest_swept_imbalance);
    }
    std::printf("  steps                 %ld, %.1f pressure iterations each\n", counters.steps,
                double(counters.iterations) / steps);
    if (counters.fallbacks > 0) {
      std::printf("                        pressure of %ld solved by the fallback\n",
                  counters.fallbacks);
    }
    if (counters.shortened > 0) {
      std::printf("                        %ld were shorter than run.step to stay stable\n",
                  counters.shortened);
    }
    if (gas_case.numerics.viscosity == Viscosity::implicit_step) {
      std::printf("                        viscosity implicit, %.1f iterations each\n",
                  double(counters.viscous_iterations) / steps);
    }
    print_limits(report, counters);
    std::printf("  wall time             %s (%s)\n",
                wall < 60.0 ? text("%.2f s", wall).c_str() : duration(wall).c_str(),
                shares(times, wall).c_str());
    std::fflush(stdout);
  }
  if (gas_case.output.directory.empty()) return;
  run_collectively(solver_.decomposition().communicator(), [&] {
    if (!talks_) return;
    write_summary((std::filesystem::path(gas_case.output.directory) / "summary.json").string(),
                  {.case_name = "gas", .commit = source_commit(), .quantities = quantities});
  });
}

void RunDisplay::print_limits(const StepReport& report, const RunCounters& counters) const {
  std::printf("                        bound by");
  for (int n = 0; n < step_limit_count; ++n) {
    std::printf("%s %s %ld", n > 0 ? "," : "", name_of(static_cast<StepLimit>(n)),
                counters.limited[n]);
  }
  std::printf("\n");
  if (counters.backflow_steps > 0) {
    std::printf("  backflow              up to %.5e m^3/s through outlets, in %ld steps\n",
                counters.largest_backflow, counters.backflow_steps);
  }
  for (int d = 0; d < 3; ++d) {
    if (report.driving_gradient[d] == 0.0) continue;
    std::printf("  driving gradient      %.6e Pa/m along %c\n", report.driving_gradient[d],
                "xyz"[d]);
  }
}

double RunDisplay::elapsed() const {
  return MPI_Wtime() - started_at_;
}

StepTimes RunDisplay::mean_times() const {
  std::array sums{times_.predictor, times_.boundary, times_.pressure, times_.correction};
  const Decomposition& decomposition = solver_.decomposition();
  MPI_Allreduce(MPI_IN_PLACE, sums.data(), int(sums.size()), MPI_DOUBLE, MPI_SUM,
                decomposition.communicator());
  for (double& sum : sums) sum /= decomposition.size();
  return {sums[0], sums[1], sums[2], sums[3]};
}

}  // namespace gasgrain::cfd
