#include "cfd/csv_table.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include "coupling/shared/error.hpp"

namespace gasgrain::cfd {

namespace {

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::vector<std::string> fields_of(const std::string& line) {
  std::vector<std::string> fields;
  std::istringstream in(line);
  for (std::string field; std::getline(in, field, ',');) fields.push_back(trimmed(field));
  return fields;
}

double number(const std::string& field, const std::string& where) {
  std::size_t used = 0;
  double value = 0.0;
  try {
    value = std::stod(field, &used);
  } catch (const std::exception&) {
    used = 0;
  }
  if (used == 0 || used != field.size() || !std::isfinite(value)) {
    throw UserError(where + ": '" + field + "' is not a finite number");
  }
  return value;
}

std::vector<double> numbers(const std::string& line, std::size_t columns,
                            const std::string& where) {
  const std::vector<std::string> fields = fields_of(line);
  if (fields.size() != columns) {
    throw UserError(where + ": has " + std::to_string(fields.size()) +
                    " fields, but the first line names " + std::to_string(columns) + " columns");
  }
  std::vector<double> row;
  for (const std::string& field : fields) row.push_back(number(field, where));
  return row;
}

}  // namespace

int CsvTable::column(const std::string& name) const {
  const auto found = std::find(columns.begin(), columns.end(), name);
  return found == columns.end() ? -1 : static_cast<int>(found - columns.begin());
}

CsvTable read_csv(const std::string& path) {
  std::ifstream in(path);
  if (!in) throw UserError("cannot read '" + path + "'; check the path");
  CsvTable table;
  int line_number = 0;
  for (std::string line; std::getline(in, line);) {
    ++line_number;
    line = trimmed(line);
    if (line.empty() || line.front() == '#') continue;
    if (table.columns.empty()) {
      table.columns = fields_of(line);
    } else {
      const std::string where = path + ":" + std::to_string(line_number);
      table.rows.push_back(numbers(line, table.columns.size(), where));
    }
  }
  if (table.rows.empty()) {
    throw UserError("'" + path +
                    "' has no rows; give a line of column names, then rows of numbers");
  }
  return table;
}

}  // namespace gasgrain::cfd
