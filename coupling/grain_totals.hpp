// Sums over all grains of all ranks at one moment.
#pragma once

#include <string>

#include "cfd/state_archive.hpp"
#include "coupling/shared/vec3.hpp"

namespace gasgrain::coupling {

struct GrainTotals {
  long count = 0;
  double mass = 0.0;                // kg
  Vec3 momentum = Vec3::Zero();     // kg m/s
  Vec3 mass_moment = Vec3::Zero();  // kg m: mass times place
  double kinetic_energy = 0.0;      // J, translation
  double rotation_energy = 0.0;     // J
  double elastic_energy = 0.0;      // J, normal springs between grains of `model cgm`
};

// `prefix` tells names apart when an archive holds several.
void visit_state(cfd::StateArchive& archive, const std::string& prefix, GrainTotals& totals);

}  // namespace gasgrain::coupling
