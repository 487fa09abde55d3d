// Grains that LIGGGHTS let fall into a packing.
#pragma once

#include <vector>

#include "coupling/shared/vec3.hpp"

namespace gasgrain::verification {

struct PackingScene {
  double diameter = 5e-4;  // m
  double width = 10;       // of the periodic square cross-section, diameters
  int count = 6800;        // of grains
  double time = 0.5;       // of the settling, s
};

struct Packing {
  std::vector<Vec3> centres;  // m; on a floor at z = 0, the corner of the box in the origin
  double speed = 0.0;         // m/s, root mean square when the settling ended
};

// For one rank. Grains of 2500 kg/m^3, friction 0.3, on springs of 30 N/m; with the defaults about
// ten seconds.
Packing settled_packing(const PackingScene& scene);

}  // namespace gasgrain::verification
