#include "coupling/grain_totals.hpp"

namespace gasgrain::coupling {

void visit_state(cfd::StateArchive& archive, const std::string& prefix, GrainTotals& totals) {
  archive.number_of(prefix + "grain_count", totals.count);
  archive.number(prefix + "grain_mass", totals.mass);
  for (int d = 0; d < 3; ++d) {
    const std::string axis(1, "xyz"[d]);
    archive.number(prefix + "grain_momentum_" + axis, totals.momentum[d]);
    archive.number(prefix + "grain_moment_" + axis, totals.mass_moment[d]);
  }
  archive.number(prefix + "kinetic_energy", totals.kinetic_energy);
  archive.number(prefix + "rotation_energy", totals.rotation_energy);
  archive.number(prefix + "elastic_energy", totals.elastic_energy);
}

}  // namespace gasgrain::coupling
