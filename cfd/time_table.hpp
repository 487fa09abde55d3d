// A factor that changes with time: linear between the rows of a table, once or periodically.
#pragma once

#include <vector>

#include "coupling/shared/config_table.hpp"

namespace gasgrain::cfd {

struct TimeTable {
  std::vector<double> times;   // s, increasing; empty = the factor is 1 at all times
  std::vector<double> values;  // -
  double period = 0.0;         // s; 0 = once. The last row is followed by the first one, a period
                               // after itself.

  bool covers(double time) const;
  // The factor at `time`, which the table must cover.
  double at(double time) const;
  double largest_magnitude() const;  // over all times; 1 for the empty table
};

// Reads {times = [...], values = [...], period = ...} or {file = "x.csv", period = ...} with
// columns time and factor. Throws UserError: fewer than two rows, times that do not increase or do
// not start at 0 or before it, a period shorter than the table.
TimeTable read_time_table(const ConfigTable& table);

}  // namespace gasgrain::cfd
