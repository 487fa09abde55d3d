// What a coupled run remembers from exchange to exchange for its time means and closing table.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "cfd/state_archive.hpp"
#include "coupling/batch_means.hpp"
#include "coupling/run_audit.hpp"
#include "coupling/shared/vec3.hpp"
#include "liggghts_plugins/contact_statistics.hpp"

namespace gasgrain::coupling {

// The bed at one exchange.
struct BedState {
  double time = 0.0;           // s
  double height = 0.0;         // m
  double pressure_drop = 0.0;  // Pa
  double weight = 0.0;         // of the grains in the gas, N
};

// Wall time of this rank by part, s.
struct WallTimes {
  double dem = 0.0, coupling = 0.0, gas = 0.0;
  double total() const { return dem + coupling + gas; }
};

// Largest values (and a few sums) over the whole run.
struct RunExtremes {
  long exchanges = 0, gas_steps = 0, pressure_iterations = 0, pressure_fallbacks = 0, limited = 0,
       grains_outside = 0;
  double shortest_interval = 0.0, longest_interval = 0.0;  // s
  double third_law_residual = 0.0, pressure_residual = 0.0, solid_volume_residual = 0.0;
  Vec3 unbalanced = Vec3::Zero();  // N s, sum of ExchangeReport::unbalanced
  double drag_impulse = 0.0;       // N s, likewise
  double divergence = 0.0, removed_mean = 0.0;
  double momentum_residual = 0.0;  // vertical, over the weight; audited intervals
  double heating = 0.0;            // likewise, see AuditRow
  plugins::LargestOverlap overlap;
  double smallest_void_fraction = 1.0;

  void note(const ExchangeReport& report);
};

struct RunStatistics {
  RunExtremes extremes;
  std::vector<TimedSample> height, pressure_drop, weight;  // samples at exchanges
  std::vector<std::vector<TimedSample>> monitors;          // of Monitors::names(), samples at rows
  double gas_work = 0.0, dissipated = 0.0;                 // J, sums over the audited intervals
  long appeared = 0, left = 0;                             // grains
  std::map<std::string, long> violations;  // rows beyond a bound of the audit, by its name
  double grain_steps = 0.0;                // grains times DEM steps
  WallTimes wall_times;

  void note(const BedState& bed, const ExchangeReport& report);
  // Values that hold for the `interval` [s] up to `time`.
  void note_monitors(double time, double interval, const std::vector<double>& values);
  void note_audit(const AuditRow& row);
  // True for the first of its kind.
  bool note_violation(const std::string& name) { return ++violations[name] == 1; }
  // All but the wall times.
  void visit_state(cfd::StateArchive& archive);
};

}  // namespace gasgrain::coupling
