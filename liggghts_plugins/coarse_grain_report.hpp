// What the `coarsegraining` command was told, its check against the atom types at `run`, and the
// table of original particles and grains printed before the first run.
#pragma once

#include <vector>

namespace LAMMPS_NS {  // NOLINT(readability-identifier-naming): the name of LIGGGHTS
class LAMMPS;
}

namespace gasgrain::plugins {

struct CoarseGrainReport {
  std::vector<double> ratios;  // as given: one, or one per type; empty without the command
  bool printed = false;

  bool scales() const;  // whether any ratio differs from 1
};

// The report of this LIGGGHTS instance.
CoarseGrainReport& coarse_grain_report(LAMMPS_NS::LAMMPS& lmp);

// Completes one ratio for all types, or throws UserError when the number of ratios is not that of
// the atom types; prints the table on screen and log once. Collective.
void check_and_print_coarse_graining(LAMMPS_NS::LAMMPS& lmp);

// The command `run`: the report above, then LIGGGHTS's own `run`.
void run_with_report(LAMMPS_NS::LAMMPS* lmp, int argument_count, char** arguments);

}  // namespace gasgrain::plugins
