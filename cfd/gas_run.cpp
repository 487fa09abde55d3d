#include "cfd/gas_run.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "cfd/solve_failure.hpp"
#include "coupling/files/collective_error.hpp"
#include "coupling/shared/error.hpp"
#include "coupling/shared/text.hpp"

namespace gasgrain::cfd {

namespace {

constexpr int progress_lines = 20;             // of a run
constexpr double end_tolerance = 1e-9;         // of a step: a shorter rest is not a step of its own
constexpr int steps_per_good_state = 16;       // copies of the state cost memory traffic
constexpr double most_remaining_steps = 1e10;  // years: a step that small is a diverging velocity

double checked_end_time(const RunControl& run) {
  if (run.end_time > 0.0) return run.end_time;
  throw UserError("run.end_time is missing; give the simulated time to reach in s: [run] end_time");
}

// 0 stands for never.
double interval_or_never(double interval) {
  return interval > 0.0 ? interval : std::numeric_limits<double>::infinity();
}

}  // namespace

GasRun::GasRun(const GasCase& gas_case, MPI_Comm communicator)
    : case_(gas_case),
      solver_(gas_case, communicator),
      end_time_(checked_end_time(gas_case.run)),
      frame_schedule_(interval_or_never(gas_case.output.interval)),
      checkpoint_schedule_(interval_or_never(gas_case.run.checkpoint_interval)),
      progress_schedule_(end_time_ / progress_lines),
      display_(solver_, end_time_) {
  if (gas_case.fixed_bed.present) bed_.emplace(solver_);
  if (!gas_case.output.directory.empty()) {
    held_.emplace(communicator, gas_case.output.directory);
    checkpoints_.emplace(communicator, gas_case.output.directory, "gas_checkpoint");
  } else if (gas_case.run.checkpoint_interval > 0.0) {
    throw UserError(
        "run.checkpoint_interval needs a directory; give output.directory or the option --out");
  } else if (!gas_case.probes.empty()) {
    throw UserError("[[probe]] '" + gas_case.probes.front().name +
                    "' needs a directory; give output.directory or the option --out");
  }
  if (!gas_case.run.restart.empty()) restart();
  if (checkpoints_) open_files();
}

std::string GasRun::path_of_restart() const {
  if (case_.run.restart != latest_checkpoint) return case_.run.restart;
  if (!checkpoints_) {
    throw UserError(
        "run.restart = \"latest\" needs a directory to look in; give output.directory or --out");
  }
  const std::vector<std::string> paths = checkpoints_->found();
  const std::string path = first_whole_checkpoint(solver_.decomposition().communicator(), paths);
  if (!path.empty()) return path;
  throw UserError("there is no checkpoint to continue from in '" + case_.output.directory +
                  "'; start without --restart, or give the file");
}

void GasRun::restart() {
  const std::string path = path_of_restart();
  std::vector<std::string> changes;
  run_collectively(solver_.decomposition().communicator(),
                   [&] { changes = read_checkpoint(path, solver_, counters_); });
  restarted_at_ = solver_.time();
  if (checkpoints_) checkpoints_->continue_from(path);
  notes_.push_back(
      text("continues from %s at %.6g s, step %ld", path.c_str(), solver_.time(), counters_.steps));
  for (const std::string& change : changes) notes_.push_back("note: " + change);
  for (Schedule* schedule : {&frame_schedule_, &checkpoint_schedule_, &progress_schedule_}) {
    schedule->skip_to(solver_.time());
  }
}

void GasRun::open_files() {
  const std::string& directory = case_.output.directory;
  if (const auto found = checkpoints_->found(); !restarted_at_ && !found.empty()) {
    notes_.push_back("note: " + found.front() +
                     " of an earlier run goes with the first checkpoint of this one; to continue "
                     "it instead: --restart latest");
  }
  frames_.emplace(solver_.decomposition().communicator(), directory, "gas",
                  restarted_at_ ? Series::resume : Series::start_new);
  series_.emplace((std::filesystem::path(directory) / "gas.csv").string(), solver_, restarted_at_);
  if (!case_.probes.empty()) {
    probes_.emplace(case_.probes, solver_);
    probes_->open_files(solver_, directory, restarted_at_);
  }
}

RunOutcome GasRun::run() {
  first_step_ = counters_.steps;
  display_.start(case_, notes_);
  if (!restarted_at_ && case_.output.interval > 0.0) write_frame_if_due();
  while (!at_end()) {
    const double dt = next_step();
    if (bed_) bed_->update(solver_);
    keep_good_state();
    last_ = step(dt);
    last_dt_ = dt;
    record(last_, dt);
    write_frame_if_due();
    if (progress_schedule_.due(solver_.time()) || at_end()) {
      flush_series();
      display_.progress(last_, dt);
    }
    const bool stop = stop_requested() && !at_end();
    if (stop || checkpoint_schedule_.due(solver_.time()) ||
        (at_end() && case_.run.checkpoint_interval > 0.0)) {
      const std::string path = write_checkpoint();
      if (stop) display_.stopped(path, counters_.steps);
    }
    if (stop) return RunOutcome::stopped;
  }
  display_.finish(last_, counters_, case_);
  return RunOutcome::finished;
}

// The stated step, or what the limits allow, cut to meet the end time.
double GasRun::next_step() {
  const StepLimits limits = solver_.step_limits();
  const double limit = limits.smallest();
  double dt = case_.run.step > 0.0 ? std::min(case_.run.step, limit) : limit;
  if (!std::isfinite(dt)) {
    throw UserError(
        "nothing limits the time step (no velocity, viscosity or gravity); give run.step in s");
  }
  const double left = end_time_ - solver_.time();
  if (left < dt * (1.0 + end_tolerance)) return left;
  if (dt == limit) ++counters_.limited[static_cast<int>(limits.binding())];
  return dt;
}

StepReport GasRun::step(double dt) {
  try {
    if ((end_time_ - solver_.time()) / dt > most_remaining_steps) {
      throw SolveFailure(text("the step had to fall to %.3g s for stability", dt));
    }
    return solver_.advance(dt);
  } catch (const UserError& error) {
    give_up(error, dt);
  }
}

// Not of every step: see steps_per_good_state.
void GasRun::keep_good_state() {
  if (!checkpoints_ || counters_.steps % steps_per_good_state != 0) return;
  good_step_ = counters_.steps;
  good_state_.save([&](StateArchive& archive) {
    counters_.visit_state(archive);
    solver_.visit_state(archive);
  });
}

void GasRun::give_up(const UserError& error, double dt) {
  std::string message =
      text("step %ld from %.6g s, dt = %.4g s: ", counters_.steps + 1, solver_.time(), dt) +
      error.what();
  if (dynamic_cast<const SolveFailure*>(&error)) {
    message += "\n  " + describe_failure(solver_, last_, last_dt_);
  }
  if (!good_state_.empty() && good_step_ > first_step_) {
    good_state_.restore([&](StateArchive& archive) {
      counters_.visit_state(archive);
      solver_.visit_state(archive);
    });
    message += text("\n  the state at %.6g s, step %ld, before it is in ", solver_.time(),
                    counters_.steps) +
               write_checkpoint();
  }
  throw UserError(message);
}

void GasRun::record(const StepReport& report, double dt) {
  ++counters_.steps;
  counters_.iterations += report.pressure.iterations;
  counters_.viscous_iterations += report.viscous_iterations;
  counters_.fallbacks += report.pressure.fallbacks;
  counters_.largest_divergence = std::max(counters_.largest_divergence, report.divergence);
  counters_.largest_backflow = std::max(counters_.largest_backflow, report.backflow);
  if (report.backflow > 0.0) ++counters_.backflow_steps;
  counters_.largest_removed_mean = std::max(counters_.largest_removed_mean, report.removed_mean);
  counters_.largest_swept_imbalance =
      std::max(counters_.largest_swept_imbalance, report.swept_imbalance);
  if (case_.run.step > 0.0 && dt < case_.run.step && !at_end()) ++counters_.shortened;
  display_.count(report);
  if (series_) series_->write(solver_, report, dt);
  if (probes_) probes_->take(solver_);
}

void GasRun::write_frame_if_due() {
  if (!frames_) return;
  const bool first = counters_.steps == 0;
  if (!frame_schedule_.due(solver_.time()) && !first && !at_end()) return;
  write_frame(*frames_, solver_, solver_.time());
}

void GasRun::flush_series() {
  if (!series_) return;
  run_collectively(solver_.decomposition().communicator(), [&] {
    series_->flush();
    if (probes_) probes_->flush();
  });
}

// A signal may have reached some ranks only.
bool GasRun::stop_requested() const {
  int raised = stop_signal_.raised() ? 1 : 0;
  MPI_Allreduce(MPI_IN_PLACE, &raised, 1, MPI_INT, MPI_MAX, solver_.decomposition().communicator());
  return raised != 0;
}

// Lines of the series reach the file before a checkpoint that will not write them again. Returns
// the path, or "" when there is nowhere to write.
std::string GasRun::write_checkpoint() {
  if (!checkpoints_) return "";
  flush_series();
  return checkpoints_->write(
      counters_.steps, [&](Hdf5File& file) { cfd::write_checkpoint(file, solver_, counters_); });
}

}  // namespace gasgrain::cfd
