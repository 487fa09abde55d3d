// A coupled simulation without its DEM code: exchanges, monitors, audit and output on one time
// line.
//
// Protocol, all calls collective:
//   begin()             once, in the set-up of the first run
//   continue_run()      in the set-up of every later run
//   force_applied(dt)   in every DEM step, after the held forces were added to the grains; with
//                       coupling.drag_update = "dem-step" also the sum of forces on this rank's
//                       grains, and set_up(sum) after the set-up of a run
//   step_finished()     at the end of every DEM step; true when an exchange is due
//   exchange()          when step_finished() said so
//   grain_appeared()    for every grain of this rank that is inserted, before its first force
//   grain_left()        for every grain of this rank that leaves the box, before it is deleted
//   finish_run()        at the end of every run
//   pause()             instead, when the run goes on after a checkpoint
//   save()              between runs; restore() instead of begin(), before the first set-up
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "cfd/probes.hpp"
#include "coupling/bed_monitor.hpp"
#include "coupling/dem_host.hpp"
#include "coupling/gas_coupling.hpp"
#include "coupling/monitors.hpp"
#include "coupling/run_audit.hpp"
#include "coupling/run_files.hpp"
#include "coupling/run_statistics.hpp"
#include "coupling/shared/schedule.hpp"

namespace gasgrain::coupling {

// One line of timeseries.csv, and the vector output of fix couple/gas.
struct SeriesRow {
  double time = 0.0;  // of the gas, s
  BedState bed;
  double weight_over_area = 0.0;  // Pa
  ExchangeReport exchange;
  AuditRow audit;                // since the row before
  std::vector<double> monitors;  // of Monitors::names()
};

class CoupledRun {
 public:
  // `directory` overrides [output] directory unless it is empty. Throws UserError.
  CoupledRun(const std::string& case_file, const std::string& directory, DemHost& host,
             MPI_Comm communicator);

  void begin(std::span<Vec3> forces, std::span<double> coefficients);
  bool begun() const { return begun_; }
  void continue_run();
  void set_up(const Vec3& force_sum) { audit_.set_up(force_sum); }
  void force_applied(double dem_step, const Vec3& force_sum);
  bool step_finished();
  // Whether the next step_finished() will be true.
  bool exchange_due() const { return steps_since_exchange_ + 1 >= interval_.dem_steps; }
  // `coefficients` [kg/s] are written for drag_follows_grains() only; the drag in `forces` is then
  // that at the grains' present velocities.
  void exchange(std::span<Vec3> forces, std::span<double> coefficients);
  bool drag_follows_grains() const { return case_.options.drag_update == DragUpdate::dem_step; }
  // Of the last exchange, s: over this the gas gave the forces of the grains.
  double given_interval() const { return row_.exchange.interval; }
  // `passage`.time is set here; `held` is the gas force on the grain, N.
  void grain_appeared(const GrainPassage& passage, GrainTraffic::Moment moment, double dem_step) {
    audit_.grain_appeared(passage, elapsed_, moment, dem_step);
  }
  void grain_left(const GrainPassage& passage, const Vec3& held, GrainTraffic::Moment moment,
                  double dem_step) {
    audit_.grain_left(passage, held, elapsed_, moment, dem_step);
  }
  void finish_run();
  void pause();
  // Everything but the grains and the forces they hold, into or from an HDF5 file. The host takes
  // the forces along with the grains. restore() throws UserError when the file belongs to another
  // grid.
  void save(const std::string& path);
  void restore(const std::string& path);

  const GasCoupling& coupling() const { return coupling_; }
  const std::string& directory() const { return directory_; }  // of the output, "": none
  const RunStatistics& statistics() const { return statistics_; }
  const SeriesRow& latest() const { return row_; }
  const Monitors& monitors() const { return monitors_; }
  const std::vector<double>& probe_values() const { return probes_.values(); }

 private:
  // What a case file states, read once.
  struct Case {
    cfd::GasCase gas;
    CouplingOptions options;
  };
  static Case read_case(const std::string& case_file);

  CoupledRun(const Case& settings, const std::string& directory, DemHost& host,
             MPI_Comm communicator);
  void visit_state(cfd::StateArchive& archive);
  void check_gas(cfd::StateArchive& archive) const;
  void watch_bed();
  void open_files(std::optional<double> continue_from);
  void label_grains();
  void start_clock();
  void stop_dem_clock();
  void observe_bed(const ExchangeReport& report);
  void audit();
  void judge();
  void warn_of_lone_grains();
  void choose_next_interval();
  void write_outputs(double time);
  void write_frame(double time);
  WallTimes mean_wall_times() const;

  Case case_;
  DemHost& host_;
  MPI_Comm communicator_;
  GasCoupling coupling_;
  std::optional<BedMonitor> monitor_;  // from begin() on: gravity is known
  Monitors monitors_;
  cfd::Probes probes_;
  RunAudit audit_;
  RunStatistics statistics_;
  std::string directory_;            // of the output, "": none
  std::unique_ptr<RunFiles> files_;  // from begin() or restore() on; null: no output directory
  Schedule series_schedule_, frame_schedule_, progress_schedule_;
  SeriesRow row_;

  bool begun_ = false;
  bool warned_of_lone_grains_ = false;
  CouplingInterval interval_;
  int steps_since_exchange_ = 0;
  double elapsed_ = 0.0;           // s since the last exchange
  double last_frame_time_ = -1.0;  // s
  double clock_ = 0.0;             // wall time at the start of the part under way
  double run_start_ = 0.0;         // the same at the last set-up
  long steps_at_start_ = 0;        // of the DEM, done then
};

}  // namespace gasgrain::coupling
