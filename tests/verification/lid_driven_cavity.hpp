// Lid-driven cavity of unit size against the profiles of Ghia, Ghia & Shin (1982).
#pragma once

#include <string>
#include <vector>

namespace gasgrain::verification {

// Runs the flow on cells[0]^2, cells[1]^2 ... cells, each started from the one before until its
// extremes no longer change, and checks the finest. `name` as in references.csv.
void report_cavity(const std::string& name, int reynolds_number, const std::vector<int>& cells);

}  // namespace gasgrain::verification
