#include "cfd/time_table.hpp"

#include <algorithm>
#include <cmath>

#include "cfd/csv_table.hpp"
#include "coupling/shared/error.hpp"

namespace gasgrain::cfd {

namespace {

constexpr double round_off = 1e-9;  // of the table's length: the last step may end there

void read_rows(TimeTable& result, const ConfigTable& table) {
  if (!table.has("file")) {
    result.times = table.numbers("times");
    result.values = table.numbers("values");
    return;
  }
  const CsvTable csv = read_csv(table.resolve_path(table.text("file")));
  const int time = csv.column("time"), factor = csv.column("factor");
  if (time < 0 || factor < 0 || csv.columns.size() != 2) {
    table.fail("file", "must have the columns 'time' (s) and 'factor'");
  }
  for (const std::vector<double>& row : csv.rows) {
    result.times.push_back(row[time]);
    result.values.push_back(row[factor]);
  }
}

void check_rows(const TimeTable& result, const ConfigTable& table, const std::string& key) {
  const std::vector<double>& times = result.times;
  if (times.size() != result.values.size() || times.size() < 2) {
    table.fail(key, "gives " + std::to_string(times.size()) + " times and " +
                        std::to_string(result.values.size()) + " values; give two or more of each");
  }
  const auto bad = std::adjacent_find(times.begin(), times.end(), std::greater_equal<>());
  if (bad != times.end()) {
    table.fail(key, "has times that do not increase after " + std::to_string(*bad) + " s");
  }
  if (times.front() > 0.0 && result.period == 0.0) {
    table.fail(key, "starts at " + std::to_string(times.front()) +
                        " s, but the run starts at 0; add a row or give a period");
  }
  if (result.period != 0.0 && result.period < times.back() - times.front()) {
    table.fail("period", "is shorter than the table, which spans " +
                             std::to_string(times.back() - times.front()) + " s");
  }
}

}  // namespace

bool TimeTable::covers(double time) const {
  if (times.empty() || period > 0.0) return true;
  const double slack = round_off * (times.back() - times.front());
  return time >= times.front() - slack && time <= times.back() + slack;
}

double TimeTable::at(double time) const {
  if (times.empty()) return 1.0;
  GASGRAIN_ASSERT(covers(time));
  double t = time;
  if (period > 0.0) t -= period * std::floor((time - times.front()) / period);
  const auto above = std::upper_bound(times.begin(), times.end(), t);
  if (above == times.begin()) return values.front();
  const std::size_t n = above - times.begin();
  if (n == times.size() && period == 0.0) return values.back();
  const bool wraps = n == times.size();
  const double after = wraps ? times.front() + period : times[n];
  const double length = after - times[n - 1];
  const double share = length > 0.0 ? std::min((t - times[n - 1]) / length, 1.0) : 0.0;
  return values[n - 1] + share * (values[wraps ? 0 : n] - values[n - 1]);
}

double TimeTable::largest_magnitude() const {
  double largest = times.empty() ? 1.0 : 0.0;
  for (const double value : values) largest = std::max(largest, std::abs(value));
  return largest;
}

TimeTable read_time_table(const ConfigTable& table) {
  for (const char* key : {"times", "values", "file", "period"}) table.has(key);
  table.reject_unknown_keys();
  if (table.has("file") && (table.has("times") || table.has("values"))) {
    table.fail("file", "is given beside times and values; give one of them");
  }
  TimeTable result;
  result.period = table.number_or("period", 0.0, Range::positive());
  read_rows(result, table);
  check_rows(result, table, table.has("file") ? "file" : "times");
  return result;
}

}  // namespace gasgrain::cfd
