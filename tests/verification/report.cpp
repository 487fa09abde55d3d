#include "tests/verification/report.hpp"

#include <gtest/gtest.h>
#include <mpi.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <map>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace gasgrain::verification {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> fields;
  std::istringstream in(line);
  for (std::string field; std::getline(in, field, ',');) fields.push_back(field);
  return fields;
}

struct Listed {
  Reference reference;
  std::string value, pass;  // as written
};

using Key = std::pair<std::string, std::string>;  // case, quantity

std::map<Key, Listed> read_references() {
  const std::string path = GASGRAIN_SOURCE_DIRECTORY "/tests/verification/references.csv";
  std::ifstream file(path);
  std::map<Key, Listed> result;
  std::string line;
  std::getline(file, line);  // column names
  while (std::getline(file, line)) {
    const std::vector<std::string> fields = split(line);
    if (fields.size() < 4) throw std::invalid_argument(path + ": " + line);
    result[{fields[0], fields[1]}] = {read_reference(fields[2], fields[3]), fields[2], fields[3]};
  }
  if (result.empty()) throw std::invalid_argument(path + " is empty or missing");
  return result;
}

const Listed* find_reference(const std::string& name, const std::string& quantity) {
  static const std::map<Key, Listed> references = read_references();
  const auto found = references.find({name, quantity});
  return found == references.end() ? nullptr : &found->second;
}

double number(const std::string& text) {
  std::size_t end = 0;
  const double value = std::stod(text, &end);
  if (text.find_first_not_of(' ', end) != std::string::npos) throw std::invalid_argument(text);
  return value;
}

std::string file_in_results(const std::string& name) {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  const char* directory = std::getenv("GASGRAIN_VERIFICATION_RESULTS");
  if (directory == nullptr || rank != 0) return "";
  return std::string(directory) + "/" + name + ".csv";
}

}  // namespace

Reference read_reference(const std::string& value, const std::string& pass) {
  Reference result{value.empty() ? std::nan("") : number(value), -infinity, infinity};
  if (pass.empty()) return result;
  if (const auto range = pass.find(".."); range != std::string::npos) {
    result.lower = number(pass.substr(0, range));
    result.upper = number(pass.substr(range + 2));
  } else if (pass.starts_with(">=")) {
    result.lower = number(pass.substr(2));
  } else if (pass.starts_with("<=")) {
    result.upper = number(pass.substr(2));
  } else if (pass.ends_with("%") && !value.empty()) {
    const double share = number(pass.substr(0, pass.size() - 1)) / 100.0;
    result.lower = result.value - share * std::abs(result.value);
    result.upper = result.value + share * std::abs(result.value);
  } else {
    throw std::invalid_argument("references.csv: '" + value + "', '" + pass + "'");
  }
  return result;
}

bool has_reference(const std::string& case_name, const std::string& quantity) {
  return find_reference(case_name, quantity) != nullptr;
}

Report::Report(const std::string& name, const std::string& title)
    : name_(name), path_(file_in_results(name)) {
  if (path_.empty()) return;
  std::ofstream(path_) << "# title: " << title << "\nquantity,grid,value,reference,pass,result\n";
}

void Report::record(const std::string& row) {
  if (path_.empty()) return;
  std::ofstream file(path_, std::ios::app);
  file << row << "\n";
  EXPECT_TRUE(file.good()) << path_;
}

void Report::check(const std::string& quantity, const std::string& grid, double value) {
  const Listed* listed = find_reference(name_, quantity);
  ASSERT_NE(listed, nullptr) << "references.csv has no row " << name_ << "," << quantity;
  EXPECT_GE(value, listed->reference.lower) << name_ << ", " << quantity << ", " << grid;
  EXPECT_LE(value, listed->reference.upper) << name_ << ", " << quantity << ", " << grid;
  const bool passed = value >= listed->reference.lower && value <= listed->reference.upper;
  const char* result = listed->pass.empty() ? "" : passed ? "pass" : "MISS";
  std::ostringstream row;
  row.precision(7);
  row << quantity << "," << grid << "," << value << "," << listed->value << "," << listed->pass
      << "," << result;
  record(row.str());
}

void Report::note(const std::string& quantity, const std::string& grid, double value) {
  const Listed* listed = find_reference(name_, quantity);
  std::ostringstream row;
  row.precision(7);
  row << quantity << "," << grid << "," << value << "," << (listed ? listed->value : "") << ",,";
  record(row.str());
}

void Report::curve(const std::string& curve_name, const std::vector<std::string>& columns,
                   const std::vector<std::vector<double>>& rows) const {
  const std::string path = file_in_results(name_ + "_" + curve_name);
  if (path.empty()) return;
  std::ofstream file(path);
  file.precision(7);
  for (std::size_t n = 0; n < columns.size(); ++n) file << (n ? "," : "") << columns[n];
  file << "\n";
  for (const std::vector<double>& row : rows) {
    for (std::size_t n = 0; n < row.size(); ++n) file << (n ? "," : "") << row[n];
    file << "\n";
  }
  EXPECT_TRUE(file.good()) << path;
}

double observed_order(double coarse, double fine, double ratio) {
  return std::log(coarse / fine) / std::log(ratio);
}

}  // namespace gasgrain::verification
