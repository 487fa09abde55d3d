// What a verification case measured, checked against references.csv and recorded for the table in
// docs/verification.md.
#pragma once

#include <string>
#include <vector>

namespace gasgrain::verification {

// What references.csv states of one quantity of one case.
struct Reference {
  double value = 0.0;               // NaN: only bounds
  double lower = 0.0, upper = 0.0;  // the measured value passes within
};

// Reads "VALUE" (may be empty) and one of "N %" (around VALUE), "LOW .. HIGH", ">= LOW", "<= HIGH"
// or nothing (only to compare with). Throws std::invalid_argument for anything else.
Reference read_reference(const std::string& value, const std::string& pass);

// Whether references.csv lists the quantity.
bool has_reference(const std::string& case_name, const std::string& quantity);

// All calls on every rank; rank 0 writes CASE.csv and CASE_CURVE.csv into the directory that the
// environment variable GASGRAIN_VERIFICATION_RESULTS names; without it no files.
class Report {
 public:
  // `name` as in references.csv, `title` for the reader.
  Report(const std::string& name, const std::string& title);

  // Expects (as GoogleTest does) that the value passes, and records it. `grid`: "128 x 128". A
  // quantity that references.csv does not list is a failure.
  void check(const std::string& quantity, const std::string& grid, double value);
  // Records only: values on coarser grids, or without a published counterpart.
  void note(const std::string& quantity, const std::string& grid, double value);
  // A table for the figures.
  void curve(const std::string& curve_name, const std::vector<std::string>& columns,
             const std::vector<std::vector<double>>& rows) const;

 private:
  void record(const std::string& row);

  std::string name_;
  std::string path_;  // "" = no file
};

// log(coarse/fine)/log(ratio): order of a method whose error is `coarse` and, with a spacing
// smaller by `ratio`, `fine`.
double observed_order(double coarse, double fine, double ratio = 2.0);

}  // namespace gasgrain::verification
