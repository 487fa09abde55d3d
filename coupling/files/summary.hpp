// summary.json: the machine-readable result that every example, test and benchmark writes.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace gasgrain {

struct Quantity {
  std::string name;
  double value;
  std::string unit;                 // "-" when there is none
  std::optional<double> reference;  // what the value is to be compared with
  std::optional<double> tolerance;  // allowed |value - reference| / |reference|; absolute when
                                    // the reference is 0
  std::string source;               // of the reference, or what the value is
};

struct Summary {
  std::string case_name;
  std::string commit;  // of the gasgrain source
  std::vector<Quantity> quantities;
};

std::string summary_text(const Summary& summary);
// Replaces the file whole, so that a reader never sees half of it. Throws UserError.
void write_summary(const std::string& path, const Summary& summary);

// Commit of the source that this library was built from, or "unknown".
std::string source_commit();

}  // namespace gasgrain
