#include "liggghts_plugins/engine/engine_mode.hpp"

#include <lammps.h>
#include <update.h>

#include <cstring>
#include <map>
#include <string>

#include "coupling/shared/error.hpp"
#include "liggghts_plugins/engine/fused_verlet.hpp"
#include "liggghts_plugins/engine/kernel.hpp"
#include "liggghts_plugins/engine/precision_mark.hpp"

namespace gasgrain::plugins {

namespace {

EngineSettings& settings_of(const LAMMPS_NS::LAMMPS& lmp) {
  static std::map<const LAMMPS_NS::LAMMPS*, EngineSettings> all;
  return all[&lmp];
}

// The value that `names` has for `word`; throws UserError that lists the names.
template <class Value>
Value choice(const std::string& what, const std::string& word,
             const std::map<std::string, Value>& names) {
  const auto found = names.find(word);
  if (found != names.end()) return found->second;
  std::string list;
  for (const auto& [name, value] : names) list += (list.empty() ? "" : ", ") + name;
  throw UserError("gasgrain_engine: " + what + " is one of " + list +
                  (word.empty() ? "" : ", not '" + word + "'"));
}

}  // namespace

const EngineSettings& engine_settings(const LAMMPS_NS::LAMMPS& lmp) {
  return settings_of(lmp);
}

void set_engine_mode(LAMMPS_NS::LAMMPS* lmp, int argument_count, char** arguments) {
  EngineSettings settings;
  settings.mode = choice<EngineMode>(
      "the mode", argument_count > 0 ? arguments[0] : "",
      {{"off", EngineMode::off}, {"auto", EngineMode::automatic}, {"fused", EngineMode::fused}});
  for (int n = 1; n < argument_count; n += 2) {
    const std::string key = arguments[n], value = n + 1 < argument_count ? arguments[n + 1] : "";
    if (key == "precision")
      settings.precision =
          choice<Precision>(key, value, {{"full", Precision::full}, {"mixed", Precision::mixed}});
    else if (key == "kernel")
      choose_contact_kernel(value);
    else
      throw UserError("gasgrain_engine: unknown keyword '" + key +
                      "'; there are precision full|mixed and kernel avx512|avx2|generic");
  }
  settings_of(*lmp) = settings;
}

void install_engine(LAMMPS_NS::LAMMPS& lmp) {
  LAMMPS_NS::Update& update = *lmp.update;
  const EngineSettings& settings = engine_settings(lmp);
  if (settings.mode == EngineMode::off) return;
  if (std::strcmp(update.integrate_style, "verlet") != 0) return;
  mark_precision(lmp, settings.precision);
  if (dynamic_cast<FusedVerlet*>(update.integrate)) return;
  delete update.integrate;
  update.integrate = new FusedVerlet(&lmp);
}

}  // namespace gasgrain::plugins
