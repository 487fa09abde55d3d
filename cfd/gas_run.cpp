#include "cfd/gas_run.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "coupling/shared/error.hpp"

namespace gasgrain::cfd {

namespace {

constexpr int progress_lines = 20;      // of a run
constexpr double end_tolerance = 1e-9;  // of a step: a shorter rest is not a step of its own

double checked_end_time(const RunControl& run) {
  if (run.end_time > 0.0) return run.end_time;
  throw UserError("run.end_time is missing; give the simulated time to reach in s: [run] end_time");
}

}  // namespace

GasRun::GasRun(const GasCase& gas_case, MPI_Comm communicator)
    : case_(gas_case),
      solver_(gas_case, communicator),
      talks_(solver_.decomposition().rank() == 0),
      end_time_(checked_end_time(gas_case.run)) {
  if (gas_case.fixed_bed.present) bed_.emplace(solver_);
  if (gas_case.output.directory.empty()) return;
  frames_.emplace(communicator, gas_case.output.directory, "gas");
  series_.emplace((std::filesystem::path(gas_case.output.directory) / "gas.csv").string(), solver_);
}

void GasRun::run() {
  started_at_ = MPI_Wtime();
  print_start();
  StepReport report;
  if (case_.output.interval > 0.0) write_frame_if_due();
  while (solver_.time() < end_time_) {
    const double dt = next_step();
    if (bed_) bed_->update(solver_);
    report = solver_.advance(dt);
    record(report, dt);
    write_frame_if_due();
    print_progress_if_due(report, dt);
  }
  print_summary(report);
}

// The stated step, or what the limits allow, cut to meet the end time.
double GasRun::next_step() const {
  const double limit = solver_.largest_stable_step();
  double dt = case_.run.step > 0.0 ? std::min(case_.run.step, limit) : limit;
  if (!std::isfinite(dt)) {
    throw UserError(
        "nothing limits the time step (no velocity, viscosity or gravity); give run.step in s");
  }
  const double left = end_time_ - solver_.time();
  return left < dt * (1.0 + end_tolerance) ? left : dt;
}

void GasRun::record(const StepReport& report, double dt) {
  ++steps_;
  iterations_ += report.pressure.iterations;
  fallbacks_ += report.pressure.fallbacks;
  largest_divergence_ = std::max(largest_divergence_, report.divergence);
  largest_removed_mean_ = std::max(largest_removed_mean_, report.removed_mean);
  if (case_.run.step > 0.0 && dt < case_.run.step && solver_.time() < end_time_) ++shortened_;
  if (series_) series_->write(solver_, report, dt);
}

void GasRun::write_frame_if_due() {
  if (!frames_) return;
  const double interval = case_.output.interval;
  const bool last = solver_.time() >= end_time_;
  if (!last && (interval == 0.0 || solver_.time() < next_frame_)) return;
  write_frame(*frames_, solver_, solver_.time());
  if (interval > 0.0) next_frame_ = interval * (std::floor(solver_.time() / interval) + 1.0);
}

void GasRun::print_start() const {
  if (!talks_) return;
  const Decomposition& blocks = solver_.decomposition();
  const Index3& cells = blocks.grid().cells;
  std::printf("gas grid of %d x %d x %d cells in %d x %d x %d blocks, %.4g s of gas\n", cells[0],
              cells[1], cells[2], blocks.ranks()[0], blocks.ranks()[1], blocks.ranks()[2],
              end_time_);
  for (const SidePart& part : solver_.side_parts()) {
    if (part.name.empty()) continue;
    std::printf("patch '%s' on %s: %ld faces, %.6g m^2\n", part.name.c_str(),
                names_of_sides[part.direction][part.side], part.faces,
                static_cast<double>(part.faces) * blocks.grid().cell_volume() /
                    blocks.grid().spacing()[part.direction]);
  }
  std::printf("%12s %10s %9s %6s %10s %10s %12s\n", "time/s", "step/s", "Courant", "iter",
              "residual", "u_max/m/s", "remaining/s");
}

void GasRun::print_progress_if_due(const StepReport& report, double dt) {
  if (!talks_ || (solver_.time() < next_progress_ && solver_.time() < end_time_)) return;
  const double done = solver_.time() / end_time_;
  std::printf("%12.5e %10.3e %9.4f %6d %10.2e %10.3e %12.1f\n", solver_.time(), dt,
              report.courant_number, report.pressure.iterations, report.pressure.residual,
              report.largest_speed, elapsed() * (1.0 - done) / done);
  std::fflush(stdout);
  next_progress_ = end_time_ / progress_lines * (std::floor(done * progress_lines) + 1.0);
}

void GasRun::print_summary(const StepReport& report) const {
  static const char* names[3][2] = {
      {"x_lower", "x_upper"}, {"y_lower", "y_upper"}, {"z_lower", "z_upper"}};
  for (int d = 0; d < 3; ++d) {
    if (solver_.decomposition().periodic()[d]) {
      const double flux = solver_.side_flux(d, 0);
      if (talks_)
        std::printf("  %s periodic                     flux %12.5e m^3/s\n", names[d][0], flux);
      continue;
    }
    for (int side = 0; side < 2; ++side) {
      const double pressure = solver_.side_pressure(d, side), flux = solver_.side_flux(d, side);
      if (!talks_) continue;
      std::printf("  %s  pressure %12.5e Pa  flux %12.5e m^3/s\n", names[d][side], pressure, flux);
    }
  }
  if (!talks_) return;
  std::printf("  largest velocity      %12.5e m/s\n", report.largest_speed);
  std::printf("  largest divergence    %12.5e of a cell's gas\n", largest_divergence_);
  std::printf("  largest removed mean  %12.5e\n", largest_removed_mean_);
  std::printf("  steps                 %ld, %.1f pressure iterations each\n", steps_,
              static_cast<double>(iterations_) / static_cast<double>(std::max(steps_, 1L)));
  if (fallbacks_ > 0) {
    std::printf("  pressure fallback     took over in %ld steps\n", fallbacks_);
  }
  if (shortened_ > 0) {
    std::printf("  %ld steps were shorter than run.step to stay stable\n", shortened_);
  }
  std::printf("  wall time             %.2f s\n", elapsed());
}

double GasRun::elapsed() const {
  return MPI_Wtime() - started_at_;
}

}  // namespace gasgrain::cfd
