#include "coupling/estimate_command.hpp"

#include <input.h>
#include <lammps.h>
#include <modify.h>
#include <mpi.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <optional>

#include "coupling/fix_couple_gas.h"
#include "coupling/shared/error.hpp"
#include "liggghts_plugins/estimate.hpp"
#include "liggghts_plugins/register.hpp"

namespace gasgrain::coupling {

namespace {

using LAMMPS_NS::LAMMPS;

const char* const usage = "usage: gasgrain estimate SCRIPT [--gap METRES] [options of liggghts]";

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
  return new FixCoupleGas(liggghts, static_cast<int>(changed.size()), changed.data());
}

std::optional<plugins::GasCells> gas_cells(LAMMPS& liggghts) {
  LAMMPS_NS::Modify& modify = *liggghts.modify;
  for (int n = 0; n < modify.nfix; ++n) {
    if (const auto* gas = dynamic_cast<const FixCoupleGas*>(modify.fix[n]))
      return plugins::GasCells{.size = gas->cell_size().maxCoeff()};
  }
  return std::nullopt;
}

double read_gap(const std::string& word) {
  char* end = nullptr;
  const double gap = std::strtod(word.c_str(), &end);
  if (word.empty() || *end != '\0' || !(gap > 0.0 && gap < 1e6))
    throw UserError("gasgrain estimate: --gap is '" + word +
                    "', but must be a length in metres above 0; " + usage);
  return gap;
}

}  // namespace

EstimateArguments read_estimate_arguments(const std::string& program,
                                          const std::vector<std::string>& arguments) {
  EstimateArguments result;
  std::vector<std::string> rest;
  for (std::size_t n = 0; n < arguments.size(); ++n) {
    if (arguments[n] == "--gap")
      result.gap = read_gap(++n < arguments.size() ? arguments[n] : "");
    else
      rest.push_back(arguments[n]);
  }
  if (rest.empty()) throw UserError(std::string("gasgrain estimate: no script; ") + usage);
  result.liggghts = {program, "-in", rest[0], "-screen", "/dev/null", "-log", "none"};
  result.liggghts.insert(result.liggghts.end(), rest.begin() + 1, rest.end());
  return result;
}

std::string estimate_script(LAMMPS& liggghts, double gap) {
  constexpr double seconds_per_run = 2.0;
  plugins::prepare_estimate(liggghts, seconds_per_run);
  plugins::register_fix(liggghts, "couple/gas", create_gas_of_estimate);
  liggghts.input->file();
  const std::string report =
      plugins::estimate_text(liggghts, {.gap = gap, .gas = gas_cells(liggghts)});
  MPI_Barrier(MPI_COMM_WORLD);
  std::filesystem::remove_all(scratch_directory());
  return report;
}

}  // namespace gasgrain::coupling
