// The command `gasgrain_engine off|auto|fused [precision full|mixed] [kernel avx512|avx2|generic]`
// and the installation of the fused time integrator.
#pragma once

#include "liggghts_plugins/engine/records.hpp"

namespace LAMMPS_NS {  // NOLINT(readability-identifier-naming): the name of LIGGGHTS
class LAMMPS;
}

namespace gasgrain::plugins {

enum class EngineMode {
  off,        // LIGGGHTS's own time integration, output character for character that of liggghts
  automatic,  // fused where everything in the scene is understood, else LIGGGHTS's own
  fused       // an error where it is not
};

struct EngineSettings {
  EngineMode mode = EngineMode::automatic;
  Precision precision = Precision::full;  // of the fused engine
};

const EngineSettings& engine_settings(const LAMMPS_NS::LAMMPS& lmp);

// The command; throws UserError for anything but the above. What is not stated is as by default,
// but a kernel once chosen stays.
void set_engine_mode(LAMMPS_NS::LAMMPS* lmp, int argument_count, char** arguments);

// Makes the fused integrator that of the next run, unless the mode is off or the script chose
// another integrator than verlet. Repeated calls are harmless; call before every run, because
// `run_style` and `clear` make a new one.
void install_engine(LAMMPS_NS::LAMMPS& lmp);

}  // namespace gasgrain::plugins
