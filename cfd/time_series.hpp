// The CSV file of a gas run: one line per step.
#pragma once

#include <fstream>
#include <string>

#include "cfd/gas_solver.hpp"

namespace gasgrain::cfd {

class TimeSeries {
 public:
  // Collective; rank 0 opens the file. Throws UserError on every rank when it cannot be written.
  TimeSeries(const std::string& path, const GasSolver& solver);

  // Collective: appends a line.
  void write(const GasSolver& solver, const StepReport& report, double dt);

 private:
  std::ofstream file_;  // open on rank 0 only
};

}  // namespace gasgrain::cfd
