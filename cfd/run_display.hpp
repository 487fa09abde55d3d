// What a run of the gas alone says: start, progress and end on the terminal, summary.json. Rank 0
// prints; all calls are collective.
#pragma once

#include <string>
#include <vector>

#include "cfd/gas_checkpoint.hpp"
#include "cfd/gas_solver.hpp"

namespace gasgrain::cfd {

// Wall time of the parts of a run, s.
struct StepTimes {
  double predictor = 0.0;   // convection, viscous stress, drag
  double boundary = 0.0;    // sides and immersed bodies
  double pressure = 0.0;    // coefficients and solve
  double correction = 0.0;  // velocity, reports and budgets
};

class RunDisplay {
 public:
  // `end_time` [s] of the run. The solver stays alive.
  RunDisplay(const GasSolver& solver, double end_time);

  void start(const GasCase& gas_case, const std::vector<std::string>& notes);
  // Every step.
  void count(const StepReport& report);
  void progress(const StepReport& report, double dt) const;
  // After a signal; `checkpoint` is a path or "".
  void stopped(const std::string& checkpoint, long steps) const;
  // The closing table, and summary.json when there is an output directory.
  void finish(const StepReport& report, const RunCounters& counters, const GasCase& gas_case) const;

 private:
  void print_patches() const;
  void print_limits(const StepReport& report, const RunCounters& counters) const;
  double elapsed() const;
  StepTimes mean_times() const;

  const GasSolver& solver_;
  bool talks_;  // this rank prints
  double end_time_;
  double start_time_ = 0.0;  // s, of the simulation, where this run started or continued
  double started_at_ = 0.0;  // s, wall time
  StepTimes times_;          // of this rank
};

}  // namespace gasgrain::cfd
