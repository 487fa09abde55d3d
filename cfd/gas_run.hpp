// A run of the gas alone: the time loop of gasgrain-gas with its files and checkpoints.
#pragma once

#include <mpi.h>

#include <optional>
#include <string>
#include <vector>

#include "cfd/field_output.hpp"
#include "cfd/fixed_bed.hpp"
#include "cfd/gas_checkpoint.hpp"
#include "cfd/gas_solver.hpp"
#include "cfd/probes.hpp"
#include "cfd/run_display.hpp"
#include "cfd/time_series.hpp"
#include "coupling/files/checkpoint_files.hpp"
#include "coupling/files/output_directory.hpp"
#include "coupling/shared/error.hpp"
#include "coupling/shared/schedule.hpp"
#include "coupling/shared/stop_signal.hpp"

namespace gasgrain::cfd {

enum class RunOutcome { finished, stopped };  // stopped: a signal asked for it before the end

class GasRun {
 public:
  // Collective. Continues from the checkpoint that the case names, if it names one. Throws
  // UserError when the case has no end time or does not fit the checkpoint.
  GasRun(const GasCase& gas_case, MPI_Comm communicator);

  // Advances to the end time or until a signal, writes the files and prints to standard output on
  // rank 0. When a step fails, the last good state becomes a checkpoint and the UserError says
  // which.
  RunOutcome run();

 private:
  void restart();
  std::string path_of_restart() const;
  void open_files();
  double next_step();
  StepReport step(double dt);
  void keep_good_state();
  [[noreturn]] void give_up(const UserError& error, double dt);
  void record(const StepReport& report, double dt);
  void write_frame_if_due();
  void flush_series();
  bool stop_requested() const;
  std::string write_checkpoint();
  bool at_end() const { return solver_.time() >= end_time_; }

  const GasCase case_;
  GasSolver solver_;
  double end_time_;  // s
  std::optional<FixedBedDrag> bed_;
  RunCounters counters_;
  StepReport last_;       // of the last step
  double last_dt_ = 0.0;  // s, 0 before the first step
  std::optional<OutputDirectory> held_;
  std::optional<CheckpointFiles> checkpoints_;
  std::optional<double> restarted_at_;  // s
  std::vector<std::string> notes_;      // what the user should know before the first step
  std::optional<FrameWriter> frames_;
  std::optional<TimeSeries> series_;
  std::optional<Probes> probes_;
  Schedule frame_schedule_, checkpoint_schedule_, progress_schedule_;
  StateCopy good_state_;
  long good_step_ = 0;   // the number of steps done in it
  long first_step_ = 0;  // the same where this run started or continued
  RunDisplay display_;
  StopSignal stop_signal_;
};

}  // namespace gasgrain::cfd
