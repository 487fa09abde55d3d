// gasgrain: LIGGGHTS with coarse grains, SDF walls and gas. Same command line as liggghts; --help,
// --version and `estimate` are ours.
#include <mpi.h>

#include <csignal>
#include <cstdio>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

// LIGGGHTS
#include <input.h>
#include <lammps.h>
#include <signal_handling.h>
#include <universe.h>

#include "coupling/estimate_command.hpp"
#include "coupling/fatal_error.hpp"
#include "coupling/fix_couple_gas.h"
#include "coupling/shared/error.hpp"
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

template <class Task>
void with_liggghts(const std::vector<std::string>& words, Task&& task) {
  gasgrain::coupling::FatalErrors errors(MPI_COMM_WORLD);
  std::vector<std::string> kept = words;
  std::vector<char*> arguments;
  for (std::string& word : kept) arguments.push_back(word.data());
  auto* liggghts = new LAMMPS(static_cast<int>(arguments.size()), arguments.data(), MPI_COMM_WORLD);
  try {
    register_all_styles(*liggghts);
    task(*liggghts);
  } catch (const gasgrain::UserError& error) {
    errors.end_program(error.what(), liggghts->logfile);
  } catch (const std::exception& error) {
    errors.end_program(std::string("internal error of gasgrain: ") + error.what(),
                       liggghts->logfile);
  }
  delete liggghts;
}

void estimate(const std::vector<std::string>& words) {
  using namespace gasgrain::coupling;
  EstimateArguments arguments;
  try {
    arguments = read_estimate_arguments(words[0], {words.begin() + 2, words.end()});
  } catch (const gasgrain::UserError& error) {
    FatalErrors(MPI_COMM_WORLD).end_program(error.what(), nullptr);
  }
  with_liggghts(arguments.liggghts, [&](LAMMPS& liggghts) {
    print_on_first_rank(estimate_script(liggghts, arguments.gap));
  });
}

}  // namespace

int main(int argc, char** argv) {
  install_signal_handlers();
  MPI_Init(&argc, &argv);
  if (is_alone(argc, argv, "--version")) {
    print_on_first_rank(version_text());
  } else if (is_alone(argc, argv, "--help")) {
    describe_all_styles();
    print_on_first_rank(help_text());
  } else if (argc > 1 && std::strcmp(argv[1], "estimate") == 0) {
    estimate({argv, argv + argc});
  } else {
    with_liggghts({argv, argv + argc}, [](LAMMPS& liggghts) { liggghts.input->file(); });
  }
  MPI_Finalize();
}
