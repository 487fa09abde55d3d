// The probes of a run: their last values, and their files probe_<name>.csv.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cfd/probe.hpp"
#include "coupling/files/csv_file.hpp"
#include "coupling/shared/schedule.hpp"

namespace gasgrain::cfd {

class Probes {
 public:
  // Collective.
  Probes(const std::vector<ProbeSettings>& settings, const GasSolver& solver);

  // Collective; rank 0 opens the files, or continues them after `continue_from` [s]. Without it
  // nothing is written. Throws UserError on every rank.
  void open_files(const GasSolver& solver, const std::string& directory,
                  std::optional<double> continue_from);

  // Collective, after every step: samples the probes whose time has come, a row of their files.
  void take(const GasSolver& solver);
  // Hands the rows to the operating system. Throws UserError on rank 0 only.
  void flush();

  // The last rows of all probes but lines, without the times, one after the other in the order of
  // the case; the same on every rank, 0 before the first.
  const std::vector<double>& values() const { return values_; }

 private:
  struct Entry {
    std::string name;
    std::unique_ptr<Probe> probe;
    std::vector<std::string> columns;
    Schedule schedule;
    std::ptrdiff_t place;         // in values_; -1: a line
    std::optional<CsvFile> file;  // on rank 0 only
  };
  std::vector<Entry> entries_;
  std::vector<double> values_;
};

}  // namespace gasgrain::cfd
