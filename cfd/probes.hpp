// The probes of a run with their files: probe_<name>.csv in the output directory.
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
  // Collective; rank 0 opens the files, or continues them after `continue_from` [s]. Throws
  // UserError on every rank.
  Probes(const std::vector<ProbeSettings>& settings, const std::string& directory,
         const GasSolver& solver, std::optional<double> continue_from);

  // Collective, after every step: adds rows to the files whose time has come.
  void write(const GasSolver& solver);
  // Hands the rows to the operating system. Throws UserError on rank 0 only.
  void flush();

 private:
  struct Entry {
    std::unique_ptr<Probe> probe;
    std::size_t columns;
    Schedule schedule;
    std::optional<CsvFile> file;  // on rank 0 only
  };
  std::vector<Entry> entries_;
};

}  // namespace gasgrain::cfd
