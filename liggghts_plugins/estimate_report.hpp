// What `gasgrain estimate` says about a script whose runs were measured.
#pragma once

#include <string>
#include <vector>

#include "liggghts_plugins/estimate.hpp"

namespace gasgrain::plugins {

struct MeasuredRun {
  double steps;             // that the script asks for
  double step;              // s
  double seconds_per_step;  // wall time
  double grains;
  bool with_gas;
};

// `bytes`: memory that the script took on all ranks. Collective.
std::string estimate_report(LAMMPS_NS::LAMMPS& lmp, const std::vector<MeasuredRun>& runs,
                            double bytes, const EstimateContext& context);

}  // namespace gasgrain::plugins
