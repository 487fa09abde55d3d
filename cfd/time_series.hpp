// The CSV file of a gas run: one line per step.
#pragma once

#include <optional>
#include <string>

#include "cfd/gas_solver.hpp"
#include "coupling/files/csv_file.hpp"

namespace gasgrain::cfd {

class TimeSeries {
 public:
  // Collective; rank 0 opens the file, or continues it after `continue_from` [s]. Throws UserError
  // on every rank when it cannot be written.
  TimeSeries(const std::string& path, const GasSolver& solver, std::optional<double> continue_from);

  // Collective: appends a line.
  void write(const GasSolver& solver, const StepReport& report, double dt);
  // Hands the lines to the operating system. Throws UserError on rank 0 only.
  void flush();

 private:
  std::optional<CsvFile> file_;  // on rank 0 only
};

}  // namespace gasgrain::cfd
