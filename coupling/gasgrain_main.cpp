// gasgrain: LIGGGHTS with coarse grains, SDF walls and gas. Same command line as liggghts; --help
// and
// --version are ours.
#include <mpi.h>

#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

// LIGGGHTS
#include <input.h>
#include <lammps.h>
#include <signal_handling.h>
#include <universe.h>

#include "coupling/fatal_error.hpp"
#include "coupling/fix_couple_gas.h"
#include "coupling/shared/error.hpp"
#include "liggghts_plugins/estimate.hpp"
#include "liggghts_plugins/register.hpp"

namespace {

using LAMMPS_NS::LAMMPS;

// As LIGGGHTS's own main: an interrupt or termination signal ends the run after the present step
// (and writes a restart file if the script asks for it), SIGUSR1 writes a restart file.
void install_signal_handlers() {
  struct sigaction interrupt = {}, write_restart = {};
  interrupt.sa_handler = LAMMPS_NS::SignalHandler::int_handler;
  write_restart.sa_handler = LAMMPS_NS::SignalHandler::usr1_handler;
  sigaction(SIGINT, &interrupt, nullptr);
  sigaction(SIGTERM, &interrupt, nullptr);
  sigaction(SIGUSR1, &write_restart, nullptr);
}

bool is_alone(int argc, char** argv, const char* option) {
  return argc == 2 && std::strcmp(argv[1], option) == 0;
}

// The version of the LIGGGHTS library that was found at run time.
std::string liggghts_version() {
  std::string words[] = {"gasgrain", "-log", "none", "-screen", "/dev/null"};
  char* arguments[std::size(words)];
  for (std::size_t i = 0; i < std::size(words); ++i) arguments[i] = words[i].data();
  LAMMPS liggghts(static_cast<int>(std::size(words)), arguments, MPI_COMM_SELF);
  return liggghts.universe->version;
}

std::string version_text() {
  return std::string("gasgrain ") + GASGRAIN_VERSION + "\n" + liggghts_version() + "\n";
}

std::string help_text() {
  std::string text = version_text() +
                     "\nusage: [mpirun -np N] gasgrain -in SCRIPT [options of liggghts]\n"
                     "       gasgrain estimate SCRIPT [options]   what the script will cost\n"
                     "       gasgrain -h          options and styles of LIGGGHTS\n\n"
                     "Styles added to LIGGGHTS, and where they are described:\n";
  for (const auto& style : gasgrain::plugins::described_styles())
    text += "  " + style.usage + "\n      " + style.summary + " (" + style.documentation + ")\n";
  return text + "\nAll script commands: docs/script_commands.md\n";
}

void register_all_styles(LAMMPS& liggghts) {
  using gasgrain::coupling::FixCoupleGas;
  gasgrain::plugins::register_styles(liggghts);
  gasgrain::plugins::register_fix(liggghts, "couple/gas",
                                  gasgrain::plugins::create_fix<FixCoupleGas>);
}

void describe_all_styles() {
  gasgrain::plugins::describe_plugin_styles();
  gasgrain::plugins::describe_style({"fix ID group couple/gas case CASE.toml [out DIR]",
                                     "gas of a case file that flows through the grains",
                                     "docs/coupling.md"});
}

void print_on_first_rank(const std::string& text) {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  if (rank == 0) std::fputs(text.c_str(), stdout);
}

enum class Task { run, estimate };

// Where the gas of an estimate writes; removed at its end.
std::string scratch_directory() {
  int process = static_cast<int>(getpid());
  MPI_Bcast(&process, 1, MPI_INT, 0, MPI_COMM_WORLD);
  return (std::filesystem::temp_directory_path() / ("gasgrain-estimate-" + std::to_string(process)))
      .string();
}

LAMMPS_NS::Fix* create_gas_of_estimate(LAMMPS* liggghts, int count, char** words) {
  std::string option = "out", directory = scratch_directory();
  std::vector<char*> changed;
  for (int i = 0; i < count; ++i) {
    if (words[i] == option)
      ++i;
    else
      changed.push_back(words[i]);
  }
  changed.push_back(option.data());
  changed.push_back(directory.data());
  return new gasgrain::coupling::FixCoupleGas(liggghts, static_cast<int>(changed.size()),
                                              changed.data());
}

void estimate(LAMMPS& liggghts) {
  constexpr double seconds_per_run = 2.0;
  gasgrain::plugins::prepare_estimate(liggghts, seconds_per_run);
  gasgrain::plugins::register_fix(liggghts, "couple/gas", create_gas_of_estimate);
  liggghts.input->file();
  print_on_first_rank(gasgrain::plugins::estimate_text(liggghts));
  MPI_Barrier(MPI_COMM_WORLD);
  std::filesystem::remove_all(scratch_directory());
}

void run_script(int argc, char** argv, Task task) {
  gasgrain::coupling::FatalErrors errors(MPI_COMM_WORLD);
  auto* liggghts = new LAMMPS(argc, argv, MPI_COMM_WORLD);
  try {
    register_all_styles(*liggghts);
    if (task == Task::estimate)
      estimate(*liggghts);
    else
      liggghts->input->file();
  } catch (const gasgrain::UserError& error) {
    errors.end_program(error.what(), liggghts->logfile);
  } catch (const std::exception& error) {
    errors.end_program(std::string("internal error of gasgrain: ") + error.what(),
                       liggghts->logfile);
  }
  delete liggghts;
}

}  // namespace

// `gasgrain estimate SCRIPT ...` as a silent run of the script.
void estimate_script(int argc, char** argv) {
  if (argc < 3) {
    print_on_first_rank("usage: gasgrain estimate SCRIPT [options of liggghts]\n");
    return;
  }
  std::vector<std::string> words = {argv[0],     "-in",  argv[2], "-screen",
                                    "/dev/null", "-log", "none"};
  words.insert(words.end(), argv + 3, argv + argc);
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  run_script(static_cast<int>(arguments.size()), arguments.data(), Task::estimate);
}

int main(int argc, char** argv) {
  install_signal_handlers();
  MPI_Init(&argc, &argv);
  if (is_alone(argc, argv, "--version")) {
    print_on_first_rank(version_text());
  } else if (is_alone(argc, argv, "--help")) {
    describe_all_styles();
    print_on_first_rank(help_text());
  } else if (argc > 1 && std::strcmp(argv[1], "estimate") == 0) {
    estimate_script(argc, argv);
  } else {
    run_script(argc, argv, Task::run);
  }
  MPI_Finalize();
}
