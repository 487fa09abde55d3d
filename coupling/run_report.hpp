// The words a coupled run says to its user. Pure functions of what happened.
#pragma once

#include <string>
#include <vector>

#include "coupling/run_results.hpp"

namespace gasgrain::coupling {

// What was set up, before the first step.
struct Scene {
  const cfd::GasCase& gas;
  const CouplingOptions& options;
  const GasCoupling& coupling;
  const ExchangeReport& report;
  const CouplingInterval& interval;
  GrainSizes sizes;
  double dem_step;  // s
  Vec3 gravity;     // of the grains, m/s^2
  std::vector<std::string> unmeasured_walls;
  std::string directory;  // "": no files
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
