// Tells restart files that a run was in mixed precision: a fix that does nothing else. Files of
// full precision hold no mark, so that those of stock scripts stay what they are.
#pragma once

#include "liggghts_plugins/engine/records.hpp"

namespace LAMMPS_NS {  // NOLINT(readability-identifier-naming): the name of LIGGGHTS
class LAMMPS;
}

namespace gasgrain::plugins {

// Makes the restart files from now on those of this precision, and prints a line when the run goes
// on from a file of another one. Call before every run.
void mark_precision(LAMMPS_NS::LAMMPS& lmp, Precision precision);

}  // namespace gasgrain::plugins
