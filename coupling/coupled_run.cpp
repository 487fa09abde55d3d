#include "coupling/coupled_run.hpp"

#include <cmath>
#include <limits>

#include "coupling/run_report.hpp"
#include "coupling/shared/error.hpp"

namespace gasgrain::coupling {

namespace {

constexpr double rows_per_frame = 10;  // default of coupling.series_interval

double series_interval(const CouplingOptions& options, const cfd::Output& output) {
  return options.series_interval > 0 ? options.series_interval : output.interval / rows_per_frame;
}

double progress_interval(const CouplingOptions& options, const cfd::Output& output) {
  if (options.progress_interval > 0) return options.progress_interval;
  return output.interval > 0 ? output.interval : std::numeric_limits<double>::infinity();
}

std::string output_directory(const cfd::Output& output, const std::string& directory) {
  return directory.empty() ? output.directory : directory;
}

}  // namespace

CoupledRun::Case CoupledRun::read_case(const std::string& case_file) {
  const ConfigTable file = ConfigTable::parse_file(case_file);
  Case settings;
  settings.gas = cfd::read_gas_case(file);
  settings.options = read_coupling_options(file.table_or_empty("coupling"), settings.gas.gas);
  file.reject_unknown_keys();
  if (settings.gas.fixed_bed.present) {
    file.fail("fixed_bed", "cannot be combined with grains; remove it or use gasgrain-gas");
  }
  if (!settings.gas.probes.empty()) {
    file.fail("probe", "is for gasgrain-gas; remove the probes, timeseries.csv has the bed's values");
  }
  return settings;
}

CoupledRun::CoupledRun(const std::string& case_file, const std::string& directory, DemHost& host,
                       MPI_Comm communicator)
    : CoupledRun(read_case(case_file), directory, host, communicator) {}

CoupledRun::CoupledRun(const Case& settings, const std::string& directory, DemHost& host,
                       MPI_Comm communicator)
    : case_(settings),
      host_(host),
      communicator_(communicator),
      coupling_(case_.gas, case_.options, communicator),
      series_schedule_(series_interval(case_.options, case_.gas.output)),
      frame_schedule_(case_.gas.output.interval > 0 ? case_.gas.output.interval
                                                    : std::numeric_limits<double>::infinity()),
      progress_schedule_(progress_interval(case_.options, case_.gas.output)) {
  const std::string path = output_directory(case_.gas.output, directory);
  if (!path.empty()) files_ = std::make_unique<RunFiles>(communicator, path);
}

void CoupledRun::begin(std::span<Vec3> forces) {
  begun_ = true;
  const Vec3 gravity = host_.gravity().isZero() ? case_.gas.gas.gravity : host_.gravity();
  monitor_.emplace(coupling_.gas(), coupling_.deposition().open_fraction(), vertical_of(gravity));
  row_.exchange = coupling_.begin(forces, host_.records());
  held_force_ = row_.exchange.force_on_grains;
  audit_.begin(host_.totals(), case_.options.feedback);
  host_.take_wall_impulse();
  host_.take_largest_overlap();
  choose_next_interval();
  host_.print(scene_text({.gas = case_.gas,
                          .options = case_.options,
                          .coupling = coupling_,
                          .report = row_.exchange,
                          .interval = interval_,
                          .sizes = host_.sizes(),
                          .dem_step = host_.step(),
                          .gravity = host_.gravity(),
                          .unmeasured_walls = host_.unmeasured_walls(),
                          .directory = files_ ? files_->directory() : ""}));
  write_frame(coupling_.gas().time());
  continue_run();
}

void CoupledRun::continue_run() {
  applied_force_ = held_force_;  // the set-up of a run computes all forces anew
  start_clock();
  run_start_ = clock_;
}

// Velocity Verlet gives half of a step's force in that step and half in the next one.
void CoupledRun::force_applied(double dem_step) {
  audit_.add_received(0.5 * dem_step * (applied_force_ + held_force_));
  applied_force_ = held_force_;
  elapsed_ += dem_step;
}

bool CoupledRun::step_finished() {
  return ++steps_since_exchange_ >= interval_.dem_steps;
}

void CoupledRun::exchange(std::span<Vec3> forces) {
  stop_dem_clock();
  row_.exchange = coupling_.exchange(forces, host_.records(), elapsed_);
  held_force_ = row_.exchange.force_on_grains;
  audit_.add_exchange(row_.exchange);
  statistics_.grain_steps +=
      double(row_.exchange.grains_inside + row_.exchange.grains_outside) * steps_since_exchange_;
  steps_since_exchange_ = 0;
  elapsed_ = 0.0;
  observe_bed(row_.exchange);
  write_outputs(row_.time);
  choose_next_interval();
  statistics_.wall_times.gas += row_.exchange.gas_seconds;
  statistics_.wall_times.coupling += MPI_Wtime() - clock_ - row_.exchange.gas_seconds;
  start_clock();
}

void CoupledRun::observe_bed(const ExchangeReport& report) {
  const int axis = monitor_->vertical().axis;
  row_.time = coupling_.gas().time();
  row_.bed = {.time = row_.time,
              .height = monitor_->height(coupling_.void_fraction()),
              .pressure_drop = monitor_->pressure_drop(),
              .weight = report.solid_mass * std::abs(host_.gravity()[axis])};
  row_.weight_over_area = row_.bed.weight / monitor_->cross_section();
  statistics_.note(row_.bed, report);
}

void CoupledRun::audit() {
  const int axis = monitor_->vertical().axis;
  row_.grains = host_.totals();
  row_.balance = audit_.close(row_.grains, host_.take_wall_impulse(), host_.gravity());
  const double weight = std::abs(row_.balance.grain_weight[axis]);
  row_.momentum_residual =
      weight > 0 ? row_.balance.residual[axis] / weight : row_.balance.residual[axis];
  row_.overlap = host_.take_largest_overlap();
  RunExtremes& extremes = statistics_.extremes;
  extremes.overlap.length = std::max(extremes.overlap.length, row_.overlap.length);
  extremes.overlap.relative = std::max(extremes.overlap.relative, row_.overlap.relative);
  extremes.momentum_residual =
      std::max(extremes.momentum_residual, std::abs(row_.momentum_residual));
}

void CoupledRun::choose_next_interval() {
  interval_ = choose_interval(row_.exchange.limits, host_.step(), case_.options.exchange_interval);
}

void CoupledRun::write_outputs(double time) {
  if (series_schedule_.due(time)) {
    audit();
    if (files_) files_->add_row(series_values(row_, monitor_->vertical().axis));
  }
  if (frame_schedule_.due(time)) write_frame(time);
  if (progress_schedule_.due(time)) {
    host_.print(progress_text(row_, mean_wall_times(), host_.progress(), MPI_Wtime() - run_start_));
  }
}

void CoupledRun::write_frame(double time) {
  if (!files_ || time <= last_frame_time_) return;
  files_->add_frame(time, coupling_.gas(), host_.grain_state());
  last_frame_time_ = time;
}

void CoupledRun::finish_run() {
  stop_dem_clock();
  if (statistics_.extremes.exchanges == 0) return;  // run 0
  write_frame(row_.time);
  const WallTimes times = mean_wall_times();
  const BedMeans means = bed_means(statistics_, *monitor_, case_.options.average_from);
  host_.print(closing_text(row_, statistics_, times, means));
  if (files_) {
    files_->write({.case_name = case_.options.case_name,
                   .commit = source_commit(),
                   .quantities = summary_quantities(statistics_, times, means)});
  }
}

void CoupledRun::start_clock() {
  clock_ = MPI_Wtime();
}

void CoupledRun::stop_dem_clock() {
  const double now = MPI_Wtime();
  statistics_.wall_times.dem += now - clock_;
  clock_ = now;
}

WallTimes CoupledRun::mean_wall_times() const {
  const WallTimes& mine = statistics_.wall_times;
  double sums[] = {mine.dem, mine.coupling, mine.gas};
  MPI_Allreduce(MPI_IN_PLACE, sums, 3, MPI_DOUBLE, MPI_SUM, communicator_);
  int ranks = 1;
  MPI_Comm_size(communicator_, &ranks);
  return {sums[0] / ranks, sums[1] / ranks, sums[2] / ranks};
}

}  // namespace gasgrain::coupling
