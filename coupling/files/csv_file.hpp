// A table of numbers over time, one line per row, that a restarted run continues.
//
// Belongs to one process. The first column is the time, which does not decrease; numbers are
// written so that they read back with the same bits, "nan" where there is no value.
#pragma once

#include <fstream>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace gasgrain {

class CsvFile {
 public:
  // Starts the file. With `continue_from` [s], the file that is there goes on after its last row
  // not later than that time: what a run wrote between its checkpoint and its end is dropped.
  // Throws UserError when the file cannot be written or has other columns.
  CsvFile(const std::string& path, const std::vector<std::string>& columns,
          std::optional<double> continue_from);

  void add(std::span<const double> row);
  // Hands the rows to the operating system; throws UserError when some could not be written.
  void flush();

 private:
  std::string path_;
  std::size_t columns_;
  std::ofstream out_;
};

}  // namespace gasgrain
