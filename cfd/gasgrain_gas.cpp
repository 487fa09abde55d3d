// gasgrain-gas CASE.toml: the gas solver on its own.
#include <mpi.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <iostream>
#include <optional>
#include <sstream>

#include "cfd/gas_run.hpp"
#include "coupling/files/collective_error.hpp"

namespace {

using gasgrain::ConfigTable;
using gasgrain::run_collectively;
using gasgrain::UserError;
using namespace gasgrain::cfd;

struct Options {
  std::string case_file;
  std::string directory;  // "" = as the case says
  std::string restart;    // a path, "latest" or "" = as the case says
};

int rank_of_world() {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  return rank;
}

// Nothing when the program has already said all there is to say; `code` is then its exit code.
std::optional<Options> parse(int argc, char** argv, int& code) {
  Options options;
  CLI::App app(
      "Gas flow through SDF bodies and fixed beds on a Cartesian grid. The case file is described "
      "in docs/case_file.md.");
  app.add_option("CASE.toml", options.case_file, "gas case file")->required();
  app.add_option("--out", options.directory, "directory for files, instead of output.directory");
  app.add_option("--restart", options.restart,
                 "continue from this checkpoint, instead of run.restart; 'latest': the newest of "
                 "the output directory");
  app.footer(
      "Exit code: 0 finished, 1 error (the message says what to do), 75 stopped by SIGTERM, SIGINT "
      "or SIGUSR1 with a checkpoint; continue with --restart latest.");
  app.set_version_flag("--version", "gasgrain-gas " GASGRAIN_VERSION);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    std::ostringstream out, err;
    code = app.exit(error, out, err);
    if (rank_of_world() == 0) {
      std::cout << out.str();
      std::cerr << err.str();
    }
    return std::nullopt;
  }
  return options;
}

constexpr int stopped_code = 75;  // EX_TEMPFAIL of sysexits.h: try again later

int run_case(const Options& options) {
  GasCase gas_case;
  gasgrain::run_collectively(MPI_COMM_WORLD, [&] {
    const ConfigTable file = ConfigTable::parse_file(options.case_file);
    gas_case = read_gas_case(file);
    file.reject_unknown_keys();
  });
  if (!options.directory.empty()) gas_case.output.directory = options.directory;
  if (!options.restart.empty()) gas_case.run.restart = options.restart;
  return GasRun(gas_case, MPI_COMM_WORLD).run() == RunOutcome::finished ? 0 : stopped_code;
}

int run_program(int argc, char** argv) {
  int code = 0;
  if (const std::optional<Options> options = parse(argc, argv, code)) code = run_case(*options);
  return code;
}

}  // namespace

// Every rank gets the same UserError, rank 0 prints it; anything else is ours and may have happened
// on one rank only.
int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  int code = 1;
  try {
    code = run_program(argc, argv);
  } catch (const UserError& error) {
    if (rank_of_world() == 0) std::fprintf(stderr, "gasgrain-gas: error: %s\n", error.what());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "gasgrain-gas: internal error on rank %d: %s\n", rank_of_world(),
                 error.what());
    MPI_Abort(MPI_COMM_WORLD, 2);
  }
  MPI_Finalize();
  return code;
}
