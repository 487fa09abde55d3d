#include "coupling/coupled_run.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cfd/state_file.hpp"
#include "coupling/files/collective_error.hpp"
#include "coupling/files/hdf5_file.hpp"
#include "coupling/lone_grains.hpp"
#include "coupling/run_report.hpp"
#include "coupling/shared/complete_file.hpp"
#include "coupling/shared/error.hpp"
#include "coupling/shared/text.hpp"

namespace gasgrain::coupling {

namespace {

constexpr const char* state_content = "gasgrain coupled state";
constexpr const char* state_group = "coupled";
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
  settings.options = read_coupling_options(file.table_or_empty("coupling"), settings.gas);
  file.reject_unknown_keys();
  if (settings.gas.fixed_bed.present) {
    file.fail("fixed_bed", "cannot be combined with grains; remove it or use gasgrain-gas");
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
      monitors_(case_.options.monitor),
      probes_(case_.gas.probes, coupling_.gas()),
      audit_(case_.options.audit, case_.options.feedback, drag_follows_grains(), host,
             communicator),
      directory_(output_directory(case_.gas.output, directory)),
      series_schedule_(series_interval(case_.options, case_.gas.output)),
      frame_schedule_(case_.gas.output.interval > 0 ? case_.gas.output.interval
                                                    : std::numeric_limits<double>::infinity()),
      progress_schedule_(progress_interval(case_.options, case_.gas.output)) {}

void CoupledRun::begin(std::span<Vec3> forces, std::span<double> coefficients) {
  begun_ = true;
  open_files({});
  watch_bed();
  label_grains();
  const std::vector<GrainRecord> grains = host_.records();
  row_.exchange = coupling_.begin(forces, grains, host_.time());
  if (drag_follows_grains()) coupling_.coefficients_of(coefficients);
  monitor_->observe(coupling_.void_fraction());
  row_.audit.grains = audit_.begin(row_.exchange);
  audit_.note_gas_power(forces, grains);
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

// Without an output directory nothing is written.
void CoupledRun::open_files(std::optional<double> continue_from) {
  if (directory_.empty()) return;
  files_ = std::make_unique<RunFiles>(communicator_, directory_, continue_from);
  probes_.open_files(coupling_.gas(), directory_, continue_from);
}

// 1 for the grains below the mean position along the monitored direction.
void CoupledRun::label_grains() {
  if (!monitors_.wants_labels()) return;
  const int axis = monitors_.mixing_direction();
  const std::vector<GrainRecord> grains = host_.records();
  double sums[2] = {};  // of volume, volume times position
  for (const GrainRecord& grain : grains) {
    sums[0] += grain.volume;
    sums[1] += grain.volume * grain.position[axis];
  }
  MPI_Allreduce(MPI_IN_PLACE, sums, 2, MPI_DOUBLE, MPI_SUM, communicator_);
  std::vector<double> labels;
  for (const GrainRecord& grain : grains)
    labels.push_back(sums[0] * grain.position[axis] < sums[1] ? 1.0 : 0.0);
  host_.set_labels(labels);
}

void CoupledRun::watch_bed() {
  const Vec3 gravity = host_.gravity().isZero() ? case_.gas.gas.gravity : host_.gravity();
  monitor_.emplace(coupling_.gas(), coupling_.deposition().open_fraction(), vertical_of(gravity));
}

void CoupledRun::continue_run() {
  if (!monitor_) {  // restored
    watch_bed();
    monitor_->observe(coupling_.void_fraction());
  }
  start_clock();
  run_start_ = clock_;
  steps_at_start_ = host_.progress().done;
}

void CoupledRun::force_applied(double dem_step, const Vec3& force_sum) {
  audit_.force_applied(dem_step, force_sum);
  elapsed_ += dem_step;
}

bool CoupledRun::step_finished() {
  return ++steps_since_exchange_ >= interval_.dem_steps;
}

void CoupledRun::exchange(std::span<Vec3> forces, std::span<double> coefficients) {
  stop_dem_clock();
  audit_.note_gas_work(elapsed_);
  std::vector<GrainRecord> grains = host_.records();
  host_.add_carried(grains, elapsed_, given_interval());
  row_.exchange = coupling_.exchange(forces, grains, elapsed_);
  if (drag_follows_grains()) coupling_.coefficients_of(coefficients);
  audit_.exchanged(row_.exchange);
  audit_.note_gas_power(forces, grains);
  statistics_.grain_steps +=
      double(row_.exchange.grains_inside + row_.exchange.grains_outside) * steps_since_exchange_;
  steps_since_exchange_ = 0;
  elapsed_ = 0.0;
  observe_bed(row_.exchange);
  monitors_.note_exchange(coupling_, row_.exchange.interval);
  probes_.take(coupling_.gas());
  write_outputs(row_.time);
  choose_next_interval();
  statistics_.wall_times.gas += row_.exchange.gas_seconds;
  statistics_.wall_times.coupling += MPI_Wtime() - clock_ - row_.exchange.gas_seconds;
  start_clock();
}

void CoupledRun::observe_bed(const ExchangeReport& report) {
  const int axis = monitor_->vertical().axis;
  row_.time = coupling_.gas().time();
  monitor_->observe(coupling_.void_fraction());
  row_.bed = {.time = row_.time,
              .height = monitor_->height(),
              .pressure_drop = monitor_->pressure_drop(),
              .weight = report.solid_mass * std::abs(host_.gravity()[axis])};
  row_.weight_over_area = row_.bed.weight / monitor_->cross_section();
  statistics_.note(row_.bed, report);
}

void CoupledRun::audit() {
  row_.audit = audit_.close(monitor_->vertical().axis);
  statistics_.note_audit(row_.audit);
}

// After the row is in the file: a run that stops shows the row that stopped it.
void CoupledRun::judge() {
  for (const AuditViolation& violation :
       audit_.violations(row_.audit, row_.exchange, monitor_->vertical().axis)) {
    const std::string message = text("audit at t = %.6g s: ", row_.time) + violation.text;
    if (case_.options.audit.on_violation == OnViolation::stop) throw UserError(message);
    if (statistics_.note_violation(violation.name)) {
      host_.print("WARNING: " + message + " (further ones of this kind are counted)\n");
    }
  }
}

// Once; one-way grains do not slow the gas.
void CoupledRun::warn_of_lone_grains() {
  if (warned_of_lone_grains_ || case_.options.feedback == Feedback::one_way) return;
  if (!most_grains_are_alone(row_.exchange)) return;
  const std::optional<std::string> warning = coupling::warning_of_lone_grains(
      row_.exchange, host_.sizes().largest_diameter, coupling_.kernel_width());
  if (warning) host_.print("WARNING: " + *warning + "\n");
  warned_of_lone_grains_ = warning.has_value();
}

void CoupledRun::choose_next_interval() {
  interval_ = choose_interval(row_.exchange.limits, host_.step(), case_.options.exchange_interval);
}

void CoupledRun::write_outputs(double time) {
  if (series_schedule_.due(time)) {
    audit();
    row_.monitors = monitors_.take(
        coupling_, *monitor_, monitors_.wants_labels() ? host_.labels() : std::vector<double>());
    statistics_.note_monitors(row_.time, row_.audit.balance.interval, row_.monitors);
    if (files_) files_->add_row(series_values(row_, monitors_.names(), monitor_->vertical().axis));
    judge();
    warn_of_lone_grains();
  }
  if (frame_schedule_.due(time)) write_frame(time);
  if (progress_schedule_.due(time)) {
    const RunProgress progress = host_.progress();
    host_.print(progress_text(
        row_, mean_wall_times(), progress,
        {.steps = progress.done - steps_at_start_, .seconds = MPI_Wtime() - run_start_}));
  }
}

void CoupledRun::write_frame(double time) {
  if (!files_ || time <= last_frame_time_) return;
  files_->add_frame(time, coupling_.gas(), host_.grain_state());
  if (case_.options.monitor.profile) files_->add_profile(time, monitor_->layers());
  last_frame_time_ = time;
}

void CoupledRun::pause() {
  stop_dem_clock();
}

// Under another name until it is complete: what is there under this one stays whole.
void CoupledRun::save(const std::string& path) {
  audit_.collect_from_host();
  const std::string partial = path + ".partial";
  Hdf5File file = Hdf5File::create(partial, communicator_);
  file.write_attribute("content", std::string(state_content));
  cfd::StateFile archive(file, state_group, coupling_.gas().decomposition(),
                         cfd::StateDirection::save);
  visit_state(archive);
  file.flush();
  file.close();
  run_collectively(communicator_, [&] {
    if (coupling_.gas().decomposition().rank() == 0) complete_file(partial, path);
  });
}

void CoupledRun::restore(const std::string& path) {
  Hdf5File file = Hdf5File::open(path, communicator_);
  if (!file.has_attribute("content") || file.text_attribute("content") != state_content)
    throw UserError("'" + path +
                    "' holds no state of a coupled run; keep the files of a checkpoint " +
                    "together, or start anew");
  cfd::StateFile archive(file, state_group, coupling_.gas().decomposition(),
                         cfd::StateDirection::restore);
  visit_state(archive);
  file.close();
  begun_ = true;
  open_files(row_.time);
  host_.print(text("Gas continues at t = %.6g s from %s\n", coupling_.gas().time(), path.c_str()));
}

// A run goes on in the gas it began with.
void CoupledRun::check_gas(cfd::StateArchive& archive) const {
  const auto check = [&](const char* name, double stated) {
    double stored = stated;
    archive.number(std::string("gas_") + name, stored);
    if (stored == stated) return;
    throw UserError(
        text("the run that is to be continued had gas.%s = %.10g, but the case file "
             "states %.10g; state the same, or start anew",
             name, stored, stated));
  };
  check("density", case_.gas.gas.density);
  check("viscosity", case_.gas.gas.viscosity);
}

void CoupledRun::visit_state(cfd::StateArchive& archive) {
  check_gas(archive);
  coupling_.visit_state(archive);
  audit_.visit_state(archive);
  archive.number("given_interval", row_.exchange.interval);
  monitors_.visit_state(archive);
  statistics_.visit_state(archive);
  archive.number_of("exchange_dem_steps", interval_.dem_steps);
  archive.number_of("steps_since_exchange", steps_since_exchange_);
  archive.number("elapsed_since_exchange", elapsed_);
  archive.number("last_frame_time", last_frame_time_);
  archive.number("row_time", row_.time);
  archive.number("row_height", row_.bed.height);
  archive.number("row_pressure_drop", row_.bed.pressure_drop);
  archive.number("row_weight", row_.bed.weight);
  archive.number("row_weight_over_area", row_.weight_over_area);
  archive.number("row_momentum_residual", row_.audit.momentum_residual);
  if (!archive.restores()) return;
  row_.bed.time = row_.time;
  for (Schedule* schedule : {&series_schedule_, &frame_schedule_, &progress_schedule_})
    schedule->skip_to(row_.time);
}

void CoupledRun::finish_run() {
  stop_dem_clock();
  if (statistics_.extremes.exchanges == 0) return;  // run 0
  write_frame(row_.time);
  const WallTimes times = mean_wall_times();
  const BedMeans means = bed_means(statistics_, *monitor_, case_.options.average_from);
  host_.print(closing_text(row_, statistics_, times, means));
  if (files_) {
    files_->write(
        {.case_name = case_.options.case_name,
         .commit = source_commit(),
         .quantities = summary_quantities(row_, statistics_, times, means, monitors_.names())});
    probes_.flush();
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
