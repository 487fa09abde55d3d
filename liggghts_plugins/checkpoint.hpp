// The command `gasgrain_checkpoint N DIR` or `gasgrain_checkpoint off`.
//
// With it, every `run` stops at the multiples of N steps and at its end, writes
// DIR/grains.STEP.restart and goes on as a new run: lists, forces and sorting start from what the
// file holds, so that a job continued from it has the same bits as the one that wrote it.
// DIR/latest.restart names the last complete one and is replaced in one move; the last two are
// kept. A job that gets SIGTERM or SIGINT writes one too and ends.
#pragma once

#include <string>

namespace LAMMPS_NS {  // NOLINT(readability-identifier-naming): the name of LIGGGHTS
class LAMMPS;
}

namespace gasgrain::plugins {

// The command. Throws UserError: step count not positive, wrong number of words.
void set_checkpoints(LAMMPS_NS::LAMMPS* lmp, int argument_count, char** arguments);

// LIGGGHTS's `run`, divided if checkpoints are wanted. Throws UserError for a `run` with keywords
// that cannot be divided (pre, every).
void run_with_checkpoints(LAMMPS_NS::LAMMPS& lmp, int argument_count, char** arguments);

// While a checkpoint is written: where styles put files of their own; "" otherwise.
std::string checkpoint_directory(const LAMMPS_NS::LAMMPS& lmp);
// Whether the run that ends now is only a part of the script's `run`.
bool run_goes_on(const LAMMPS_NS::LAMMPS& lmp);

}  // namespace gasgrain::plugins
