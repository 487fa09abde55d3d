#include "liggghts_plugins/engine/engine_mode.hpp"

#include <lammps.h>
#include <update.h>

#include <cstring>
#include <map>
#include <string>

#include "coupling/shared/error.hpp"
#include "liggghts_plugins/engine/fused_verlet.hpp"
#include "liggghts_plugins/engine/kernel.hpp"

namespace gasgrain::plugins {

EngineMode& engine_mode(LAMMPS_NS::LAMMPS& lmp) {
  static std::map<const LAMMPS_NS::LAMMPS*, EngineMode> modes;
  return modes.try_emplace(&lmp, EngineMode::automatic).first->second;
}

void set_engine_mode(LAMMPS_NS::LAMMPS* lmp, int argument_count, char** arguments) {
  const bool with_kernel = argument_count == 3 && std::strcmp(arguments[1], "kernel") == 0;
  const std::string mode = argument_count == 1 || with_kernel ? arguments[0] : "";
  if (mode == "off")
    engine_mode(*lmp) = EngineMode::off;
  else if (mode == "auto")
    engine_mode(*lmp) = EngineMode::automatic;
  else if (mode == "fused")
    engine_mode(*lmp) = EngineMode::fused;
  else
    throw UserError("gasgrain_engine: expects off, auto or fused" +
                    (mode.empty() ? "" : ", not '" + mode + "'") +
                    "; then, if wanted, kernel avx512|avx2|generic");
  if (with_kernel) choose_contact_kernel(arguments[2]);
}

void install_engine(LAMMPS_NS::LAMMPS& lmp) {
  LAMMPS_NS::Update& update = *lmp.update;
  if (engine_mode(lmp) == EngineMode::off) return;
  if (std::strcmp(update.integrate_style, "verlet") != 0) return;
  if (dynamic_cast<FusedVerlet*>(update.integrate)) return;
  delete update.integrate;
  update.integrate = new FusedVerlet(&lmp);
}

}  // namespace gasgrain::plugins
