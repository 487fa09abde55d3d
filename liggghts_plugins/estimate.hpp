// `gasgrain estimate SCRIPT`: what a script will cost, and the numbers an expert would look at.
//
// The script is carried out as it stands but for its runs: of each only a few steps are made, so
// that grains are inserted and the machine's speed is known. No file of the script is written: its
// dumps, restart files and checkpoints are left out.
#pragma once

#include <optional>
#include <string>

namespace LAMMPS_NS {  // NOLINT(readability-identifier-naming): the name of LIGGGHTS
class LAMMPS;
}

namespace gasgrain::plugins {

// Replaces `run` and the commands that write files, after register_styles(). `seconds` (> 0) of
// wall time are spent on the speed of each run.
void prepare_estimate(LAMMPS_NS::LAMMPS& lmp, double seconds);

// Replaces them again in an instance that estimates; nothing in others. Registering styles ends so,
// since it happens once more after a `clear`.
void replace_commands_for_estimate(LAMMPS_NS::LAMMPS& lmp);

struct GasCells {
  double size;  // of the longest edge, m
};

// What the script's own commands do not tell.
struct EstimateContext {
  double gap = 0.0;             // narrowest opening or thinnest layer, m; 0: not given
  std::optional<GasCells> gas;  // of a script with gas
};

// The report, after the script; collective. Throws UserError when the script had no run.
std::string estimate_text(LAMMPS_NS::LAMMPS& lmp, const EstimateContext& context);

}  // namespace gasgrain::plugins
