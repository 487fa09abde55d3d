// Numbers from a CSV file: a line of column names, then rows of numbers. Empty lines and lines that
// start with '#' are skipped.
#pragma once

#include <string>
#include <vector>

namespace gasgrain::cfd {

struct CsvTable {
  std::vector<std::string> columns;
  std::vector<std::vector<double>> rows;  // each as long as `columns`

  // Position of a column, or -1.
  int column(const std::string& name) const;
};

// Throws UserError that names file and line: unreadable, no row, a row of another length, a field
// that is no finite number.
CsvTable read_csv(const std::string& path);

}  // namespace gasgrain::cfd
