// The numbers that a coupled run leaves in its files: means of the bed, rows of timeseries.csv,
// quantities of summary.json. Pure functions of what happened.
#pragma once

#include <string>
#include <vector>

#include "coupling/bed_monitor.hpp"
#include "coupling/coupled_run.hpp"

namespace gasgrain::coupling {

// Time means of the bed and what they are compared with.
struct BedMeans {
  double from = 0.0, to = 0.0;     // s of gas time
  TimeMean height, pressure_drop;  // m, Pa
  double weight_over_area = 0.0;   // Pa
  double static_estimate = 0.0;    // Pa: weight over area times height x area / open volume below
};

// `from` [s of gas time]: earlier samples do not count.
BedMeans bed_means(const RunStatistics& statistics, const BedMonitor& monitor, double from);

// The columns of timeseries.csv; vectors by their component along `axis`.
std::vector<NamedValue> series_values(const SeriesRow& row,
                                      const std::vector<std::string>& monitors, int axis);

// The quantities of summary.json, with the reference of those that have one.
std::vector<Quantity> summary_quantities(const SeriesRow& row, const RunStatistics& statistics,
                                         const WallTimes& times, const BedMeans& means,
                                         const std::vector<std::string>& monitors);

}  // namespace gasgrain::coupling
