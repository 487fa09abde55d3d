#include "liggghts_plugins/register.hpp"

#include "liggghts_plugins/checkpoint.hpp"
#include "liggghts_plugins/coarse_grain_report.hpp"
#include "liggghts_plugins/coarsegraining.h"
#include "liggghts_plugins/contact_model_cgm.hpp"
#include "liggghts_plugins/engine/engine_mode.hpp"
#include "liggghts_plugins/estimate.hpp"
#include "liggghts_plugins/fix_wall_sdf.h"

namespace gasgrain::plugins {

void register_styles(LAMMPS_NS::LAMMPS& lmp) {
  register_contact_model_cgm();
  register_command(lmp, "coarsegraining", run_command<LAMMPS_NS::Coarsegraining>);
  register_command(lmp, "run", run_with_report);
  register_command(lmp, "gasgrain_engine", set_engine_mode);
  register_command(lmp, "gasgrain_checkpoint", set_checkpoints);
  register_fix(lmp, "wall/sdf", create_fix<FixWallSdf>);
  replace_commands_for_estimate(lmp);
  describe_plugin_styles();
}

void describe_plugin_styles() {
  describe_style({"coarsegraining l1 [l2 ...] [model_check error|warn]",
                  "coarse-grain ratio of each atom type, for stock models and ours",
                  "docs/coarse_graining.md"});
  describe_style({"pair_style gran model cgm tangential history [stiffness_exponent n]",
                  "linear contact law of coarse grains, in properties of the original particle",
                  "docs/script_commands.md"});
  describe_style({"fix ID group wall/gran model cgm tangential history primitive|mesh ...",
                  "the same law against the walls of stock LIGGGHTS", "docs/script_commands.md"});
  describe_style({"fix ID group wall/sdf body FILE.h5 | case CASE.toml body NAME type T",
                  "wall from a signed distance field", "docs/script_commands.md"});
  describe_style({"gasgrain_engine off|auto|fused [precision full|mixed] [kernel NAME]",
                  "whether grains are moved by the fused engine or by LIGGGHTS's own loop",
                  "docs/engine.md"});
  describe_style({"gasgrain_checkpoint N DIR | off",
                  "every N steps a checkpoint from which a run continues with the same bits",
                  "docs/restart.md"});
}

}  // namespace gasgrain::plugins
