// Registers everything this directory adds to a running LIGGGHTS.
#pragma once

#include "liggghts_plugins/style_registry.hpp"

namespace gasgrain::plugins {

// Contact model cgm (pairs and walls), the commands coarsegraining and run (stock run after the
// coarse-grain report), fix wall/sdf. Repeated calls are harmless.
void register_styles(LAMMPS_NS::LAMMPS& lmp);

// Fills described_styles() without a LIGGGHTS instance.
void describe_plugin_styles();

}  // namespace gasgrain::plugins
