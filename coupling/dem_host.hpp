// What a coupled run asks of the DEM code around it. Adapters implement it; nothing here knows
// LIGGGHTS.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "coupling/grain_transfer.hpp"
#include "coupling/momentum_audit.hpp"
#include "liggghts_plugins/contact_statistics.hpp"

namespace gasgrain::coupling {

// The coupled grains of this rank as they appear in files.
struct GrainState {
  std::vector<double> positions, velocities;  // x y z of each grain, m and m/s
  std::vector<double> radii;                  // m
  std::vector<double> types;
  std::vector<std::int64_t> ids;
};

// Steps of the present run.
struct RunProgress {
  long done = 0;
  long total = 0;
};

// Range of a property over the coupled grains of all ranks.
struct GrainSizes {
  double smallest_diameter = 0.0, largest_diameter = 0.0;  // m
  double smallest_original = 0.0, largest_original = 0.0;  // d0, m
};

class DemHost {
 public:
  virtual ~DemHost() = default;

  virtual double time() const = 0;   // s, of the script
  virtual double step() const = 0;   // s
  virtual Vec3 gravity() const = 0;  // m/s^2; known from the set-up of the first run on
  virtual RunProgress progress() const = 0;
  // IDs of walls whose force nobody measures.
  virtual std::vector<std::string> unmeasured_walls() const = 0;
  // Whether some wall's surface has moved: its work on the grains is not measured. Collective.
  virtual bool walls_move() const = 0;

  virtual std::vector<GrainRecord> records() const = 0;  // coupled grains of this rank
  // Sets what the grains carry. They hold their forces since `elapsed` [s]; for these forces the
  // gas gave over `given` [s].
  virtual void add_carried(std::vector<GrainRecord>& grains, double elapsed,
                           double given) const = 0;
  virtual GrainState grain_state() const = 0;  // the same grains
  // One number per grain that moves with it: 0 until it is set.
  virtual void set_labels(const std::vector<double>& labels) = 0;  // in the order of records()
  virtual std::vector<double> labels() const = 0;
  virtual double gas_power() const = 0;  // of the forces that this rank's grains hold, W

  // Collective.
  virtual GrainTotals totals() const = 0;
  virtual GrainSizes sizes() const = 0;
  virtual Vec3 take_wall_impulse() = 0;  // of the walls on the grains since the last call, N s
  virtual plugins::LargestOverlap take_largest_overlap() = 0;  // since the last call

  // Prints text for the user, once (on one rank); other ranks' calls do nothing.
  virtual void print(const std::string& text) = 0;
};

}  // namespace gasgrain::coupling
