// A run of the gas alone: the time loop of gasgrain-gas with its progress lines and files.
#pragma once

#include <mpi.h>

#include <optional>

#include "cfd/field_output.hpp"
#include "cfd/fixed_bed.hpp"
#include "cfd/gas_solver.hpp"
#include "cfd/time_series.hpp"

namespace gasgrain::cfd {

class GasRun {
 public:
  // Collective. Throws UserError when the case has no end time.
  GasRun(const GasCase& gas_case, MPI_Comm communicator);

  // Advances to the end time, writes the files and prints to standard output on rank 0.
  void run();

 private:
  double next_step() const;
  void record(const StepReport& report, double dt);
  void write_frame_if_due();
  void print_progress_if_due(const StepReport& report, double dt);
  void print_start() const;
  void print_summary(const StepReport& report) const;
  double elapsed() const;  // s of wall time since the start, for the display only

  const GasCase case_;
  GasSolver solver_;
  bool talks_;  // this rank prints
  std::optional<FixedBedDrag> bed_;
  std::optional<FrameWriter> frames_;
  std::optional<TimeSeries> series_;
  double end_time_;
  double next_frame_ = 0.0, next_progress_ = 0.0;
  double started_at_ = 0.0;
  long steps_ = 0, iterations_ = 0, shortened_ = 0, fallbacks_ = 0;
  double largest_divergence_ = 0.0, largest_removed_mean_ = 0.0;
};

}  // namespace gasgrain::cfd
