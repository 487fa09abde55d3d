// A small bed of grains around a tube, gas from below or closed all around: case text and grains.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "tests/coupling/coupling_scene.hpp"
#include "tests/gas_case_text.hpp"

namespace gasgrain::coupling {

// A small bed with a tube in it, gas from below.
inline const GasCaseText bed_gas{.upper = Vec3(0.010, 0.005, 0.020),
                                 .cells = {8, 4, 16},
                                 .gas = {.density = 1.2, .gravity = Vec3(0, 0, -9.81)},
                                 .x = {"no-slip", "slip"},
                                 .y = {"no-slip", "no-slip"},
                                 .z = {inlet(0.3), "outlet"}};
inline const std::string tube = R"([[body]]
name = "tube"
cylinder = {point = [0.0051, 0.0025, 0.0062], axis = [0, 1, 0], radius = 0.0021}
)";
inline const std::string bed = bed_gas.text() + tube + "[numerics]\npressure_tolerance = 1e-10\n";

// The same, closed on all sides and with a finer tolerance.
inline std::string closed_vessel() {
  GasCaseText gas = bed_gas;
  gas.x = gas.z = {"no-slip", "no-slip"};
  return gas.text() + tube + "[numerics]\npressure_tolerance = 1e-13\n";
}
inline const std::string vessel = closed_vessel();

// Grains of 0.5 mm that move at random around the tube.
inline std::vector<GrainRecord> bed_grains() {
  const GrainKind kind{.ratio = 5};
  std::vector<GrainRecord> grains;
  for (const GrainRecord& grain :
       lattice(kind, Vec3(0, 0, 0), Vec3(0.010, 0.005, 0.012), 0.00062, 0.2)) {
    const double distance =
        std::hypot(grain.position[0] - 0.0051, grain.position[2] - 0.0062) - 0.0021;
    if (distance > 0.00025) grains.push_back(grain);
  }
  return grains;
}

// Straight flight; those that would leave the vessel or enter the tube turn round.
inline void move(std::vector<GrainRecord>& grains, double dt) {
  const Vec3 lower = Vec3::Constant(0.00025), upper = Vec3(0.010, 0.005, 0.020) - lower;
  for (GrainRecord& grain : grains) {
    const Vec3 next = grain.position + dt * grain.velocity;
    const bool blocked = (next - lower).minCoeff() < 0 || (upper - next).minCoeff() < 0 ||
                         std::hypot(next[0] - 0.0051, next[2] - 0.0062) < 0.0021 + 0.00025;
    if (blocked) {
      grain.velocity = -grain.velocity;
    } else {
      grain.position = next;
    }
  }
}

}  // namespace gasgrain::coupling
