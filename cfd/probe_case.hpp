// What the case file says about probes: [[probe]].
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "cfd/grid.hpp"
#include "coupling/shared/body.hpp"
#include "coupling/shared/config_table.hpp"

namespace gasgrain::cfd {

struct PointProbe {
  Vec3 point;  // m
};

struct LineProbe {
  Vec3 from, to;  // m
  int samples;    // >= 2, both ends among them
};

struct PlaneProbe {
  int direction;    // of its normal
  double position;  // m
};

struct BoxProbe {
  Vec3 lower, upper;  // m
};

struct BodyProbe {
  std::string body;
  std::size_t index;  // among the bodies of the case
};

struct ProbeSettings {
  std::string name;       // of the file probe_<name>.csv: letters, digits, '_' and '-'
  double interval = 0.0;  // s of simulated time between rows; 0: every step
  std::variant<PointProbe, LineProbe, PlaneProbe, BoxProbe, BodyProbe> place;
};

// Throws UserError: a probe outside the grid, of an unknown body, without a place or with two.
std::vector<ProbeSettings> read_probes(const ConfigTable& file, const Grid& grid,
                                       const std::vector<Body>& bodies);

}  // namespace gasgrain::cfd
