// The command `gasgrain_engine off|auto|fused [kernel avx512|avx2|generic]` and the installation of
// the fused time integrator.
#pragma once

namespace LAMMPS_NS {  // NOLINT(readability-identifier-naming): the name of LIGGGHTS
class LAMMPS;
}

namespace gasgrain::plugins {

enum class EngineMode {
  off,        // LIGGGHTS's own time integration, output character for character that of liggghts
  automatic,  // fused where everything in the scene is understood, else LIGGGHTS's own
  fused       // an error where it is not
};

EngineMode& engine_mode(LAMMPS_NS::LAMMPS& lmp);

// The command; throws UserError for anything but off, auto or fused.
void set_engine_mode(LAMMPS_NS::LAMMPS* lmp, int argument_count, char** arguments);

// Makes the fused integrator that of the next run, unless the mode is off or the script chose
// another integrator than verlet. Repeated calls are harmless; call before every run, because
// `run_style` and `clear` make a new one.
void install_engine(LAMMPS_NS::LAMMPS& lmp);

}  // namespace gasgrain::plugins
