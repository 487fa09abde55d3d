// The words a coupled run says to its user. Pure functions of what happened.
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

BedMeans bed_means(const RunStatistics& statistics, const BedMonitor& monitor, double from);

// The columns of timeseries.csv; vectors by their component along `axis`.
std::vector<NamedValue> series_values(const SeriesRow& row,
                                      const std::vector<std::string>& monitors, int axis);
std::vector<Quantity> summary_quantities(const SeriesRow& row, const RunStatistics& statistics,
                                         const WallTimes& times, const BedMeans& means,
                                         const std::vector<std::string>& monitors);

// What was set up, before the first step.
struct Scene {
  const cfd::GasCase& gas;
  const CouplingOptions& options;
  const GasCoupling& coupling;
  const ExchangeReport& report;
  const CouplingInterval& interval;
  GrainSizes sizes;
  double dem_step;
  Vec3 gravity;
  std::vector<std::string> unmeasured_walls;
  std::string directory;
};
std::string scene_text(const Scene& scene);

// How fast the present part of a run goes: parts begin at checkpoints.
struct Pace {
  long steps = 0;        // done in it
  double seconds = 0.0;  // of wall time that they took
};

// One line while running; what is left at the pace of the present part.
std::string progress_text(const SeriesRow& row, const WallTimes& times, const RunProgress& progress,
                          const Pace& pace);

// The table at the end of a run.
std::string closing_text(const SeriesRow& row, const RunStatistics& statistics,
                         const WallTimes& times, const BedMeans& means);

}  // namespace gasgrain::coupling
