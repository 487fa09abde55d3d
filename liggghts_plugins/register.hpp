// Registers everything this directory adds to a running LIGGGHTS.
#pragma once

#include "liggghts_plugins/style_registry.hpp"

namespace gasgrain::plugins {

// Contact model cgm (pairs and walls), fix wall/sdf, the commands coarsegraining, gasgrain_engine,
// gasgrain_checkpoint and run (stock's after the coarse-grain report, divided by checkpoints); in
// an instance that estimates, what replaces them. Repeated calls are harmless; call again after a
// `clear`.
void register_styles(LAMMPS_NS::LAMMPS& lmp);

// Fills described_styles() without a LIGGGHTS instance.
void describe_plugin_styles();

}  // namespace gasgrain::plugins
