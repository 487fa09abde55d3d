// A run of the gas in a checkpoint file: the case it belongs to, how far it is, its state.
//
// Layout: attributes format, version, time; text /case, what the case file said; groups /run
// (counters), /gas (GasSolver::visit_state) and /walls (share of the cells inside bodies).
#pragma once

#include <array>
#include <string>
#include <vector>

#include "cfd/gas_solver.hpp"
#include "cfd/state_archive.hpp"
#include "coupling/files/hdf5_file.hpp"

namespace gasgrain::cfd {

// What a run tells at its end about all its steps.
struct RunCounters {
  long steps = 0;
  long iterations = 0;                           // of the pressure
  long viscous_iterations = 0;                   // of implicit viscosity
  long fallbacks = 0;                            // steps whose pressure another method had to solve
  long shortened = 0;                            // steps shorter than run.step for stability
  std::array<long, step_limit_count> limited{};  // steps by the limit that bound them
  long backflow_steps = 0;                       // steps with gas entering through outlets
  double largest_backflow = 0.0;                 // m^3/s
  double largest_divergence = 0.0, largest_removed_mean = 0.0;
  double largest_swept_imbalance = 0.0;  // see StepReport

  void visit_state(StateArchive& archive);
};

// All calls are collective over the solver's communicator.

void write_checkpoint(Hdf5File& file, GasSolver& solver, RunCounters& counters);

// Continues solver and counters from a file. Returns what the case says other than the file's about
// things that may change: sides and numerics. Throws UserError, with the key and both values, when
// grid, gas, bodies or bed differ, and when the file is no checkpoint.
std::vector<std::string> read_checkpoint(const std::string& path, GasSolver& solver,
                                         RunCounters& counters);

// The first of `paths` that is a whole checkpoint, or "".
std::string first_whole_checkpoint(MPI_Comm communicator, const std::vector<std::string>& paths);

// How a checkpoint's case and the present one differ, one line per key, for the keys that start
// with one of `sections`: "gas.density is 1.2 in the checkpoint and 1.3 in the case".
std::vector<std::string> differences(const std::vector<ConfigStatement>& before,
                                     const std::vector<ConfigStatement>& now,
                                     const std::vector<std::string>& sections);

}  // namespace gasgrain::cfd
