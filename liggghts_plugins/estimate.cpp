#include "liggghts_plugins/estimate.hpp"

#include <atom.h>
#include <dump.h>
#include <input.h>
#include <lammps.h>
#include <modify.h>
#include <mpi.h>
#include <output.h>
#include <run.h>
#include <sys/resource.h>
#include <update.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "coupling/shared/error.hpp"
#include "liggghts_plugins/contact_settings.hpp"
#include "liggghts_plugins/engine/engine_mode.hpp"
#include "liggghts_plugins/estimate_report.hpp"
#include "liggghts_plugins/style_registry.hpp"

namespace gasgrain::plugins {

namespace {

using LAMMPS_NS::bigint;
using LAMMPS_NS::LAMMPS;

struct Estimate {
  const LAMMPS* of = nullptr;
  double seconds = 1.0;  // spent on each run
  double memory_before = 0.0;
  std::vector<MeasuredRun> runs;
};

Estimate& estimate() {
  static Estimate one;
  return one;
}

// Resident memory of all ranks, bytes.
double memory(LAMMPS& lmp) {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  double bytes = 1024.0 * static_cast<double>(usage.ru_maxrss);
  MPI_Allreduce(MPI_IN_PLACE, &bytes, 1, MPI_DOUBLE, MPI_SUM, lmp.world);
  return bytes;
}

void make_steps(LAMMPS& lmp, bigint count) {
  install_engine(lmp);
  std::string word = std::to_string(count);
  char* words[] = {word.data()};
  LAMMPS_NS::Run(&lmp).command(1, words);
}

// Wall time of so many steps, the slowest rank's, s.
double timed_steps(LAMMPS& lmp, bigint count) {
  MPI_Barrier(lmp.world);
  const double start = MPI_Wtime();
  make_steps(lmp, count);
  double seconds = MPI_Wtime() - start;
  MPI_Allreduce(MPI_IN_PLACE, &seconds, 1, MPI_DOUBLE, MPI_MAX, lmp.world);
  return seconds;
}

bigint steps_of_run(const LAMMPS& lmp, int count, char** words) {
  if (count < 1) throw UserError("gasgrain estimate: `run` needs a number of steps");
  const double number = script_number(words[0], "gasgrain estimate", "run");
  const bool up_to = std::any_of(words, words + count,
                                 [](const char* word) { return std::string(word) == "upto"; });
  const auto steps = static_cast<bigint>(number);
  return up_to ? std::max<bigint>(0, steps - lmp.update->ntimestep) : steps;
}

void drop_outputs(LAMMPS& lmp) {
  while (lmp.output->ndump > 0) lmp.output->delete_dump(lmp.output->dump[0]->id);
  lmp.input->one("restart 0");
}

void run_briefly(LAMMPS* lmp, int count, char** words) {
  const bigint asked = steps_of_run(*lmp, count, words);
  drop_outputs(*lmp);
  if (asked == 0) return;
  constexpr bigint first_steps = 20;  // insertion, first neighbour list, first exchange with gas
  make_steps(*lmp, std::min(asked, first_steps));
  const double trial = timed_steps(*lmp, first_steps) / first_steps;
  const auto affordable = static_cast<bigint>(estimate().seconds / std::max(trial, 1e-9));
  const bigint measured = std::clamp<bigint>(affordable, first_steps, 1000000);
  const double seconds = timed_steps(*lmp, measured);
  estimate().runs.push_back({.steps = static_cast<double>(asked),
                             .step = lmp->update->dt,
                             .seconds_per_step = seconds / static_cast<double>(measured),
                             .grains = static_cast<double>(lmp->atom->natoms),
                             .with_gas = lmp->modify->n_fixes_style("couple/gas") > 0});
}

void leave_out(LAMMPS*, int, char**) {}

// Stock's own creators of the fixes that write files.
std::map<std::string, FixCreator>& file_writers() {
  static std::map<std::string, FixCreator> creators;
  return creators;
}

LAMMPS_NS::Fix* create_without_file(LAMMPS* lmp, int count, char** words) {
  std::string nowhere = "/dev/null";
  std::vector<char*> changed(words, words + count);
  for (int i = 0; i + 1 < count; ++i)
    if (std::string(words[i]) == "file" || std::string(words[i]) == "append")
      changed[i + 1] = nowhere.data();
  return file_writers().at(words[2])(lmp, count, changed.data());
}

}  // namespace

void prepare_estimate(LAMMPS& lmp, double seconds) {
  estimate() = {.of = &lmp, .seconds = seconds, .memory_before = memory(lmp), .runs = {}};
  replace_commands_for_estimate(lmp);
}

void replace_commands_for_estimate(LAMMPS& lmp) {
  if (estimate().of != &lmp) return;
  register_command(lmp, "run", run_briefly);
  for (const char* name : {"write_restart", "write_data", "write_dump", "gasgrain_checkpoint"})
    register_command(lmp, name, leave_out);
  for (const char* name : {"ave/time", "ave/atom", "ave/histo", "ave/correlate", "print"}) {
    const FixCreator stock = fix_creator(lmp, name);
    if (!stock || stock == create_without_file) continue;
    file_writers()[name] = stock;
    register_fix(lmp, name, create_without_file);
  }
}

std::string estimate_text(LAMMPS& lmp, const EstimateContext& context) {
  if (estimate().runs.empty())
    throw UserError("gasgrain estimate: the script has no `run` with steps");
  return estimate_report(lmp, estimate().runs, memory(lmp) - estimate().memory_before, context);
}

}  // namespace gasgrain::plugins
