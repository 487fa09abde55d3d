// `gasgrain estimate SCRIPT [--gap W] [options of liggghts]`
#pragma once

#include <string>
#include <vector>

namespace LAMMPS_NS {  // NOLINT(readability-identifier-naming): the name of LIGGGHTS
class LAMMPS;
}

namespace gasgrain::coupling {

struct EstimateArguments {
  std::vector<std::string> liggghts;  // a silent run of the script
  double gap = 0.0;                   // m; 0: not given
};

// `arguments` after the word `estimate`. Throws UserError.
EstimateArguments read_estimate_arguments(const std::string& program,
                                          const std::vector<std::string>& arguments);

// Carries out the script that `liggghts` was started with, briefly, with all styles registered, and
// returns the report. Collective. Throws UserError.
std::string estimate_script(LAMMPS_NS::LAMMPS& liggghts, double gap);

}  // namespace gasgrain::coupling
