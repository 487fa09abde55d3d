// What the fused engine takes over in a scene, or why it does not.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "coupling/shared/vec3.hpp"
#include "liggghts_plugins/engine/held_force.hpp"
#include "liggghts_plugins/engine/pair_law.hpp"

namespace LAMMPS_NS {  // NOLINT(readability-identifier-naming): the name of LIGGGHTS
class Fix;
class FixWallGran;
class LAMMPS;
}  // namespace LAMMPS_NS

namespace gasgrain::plugins {

class FixWallSdf;

struct ScenePlan {
  // What is not understood, by style as in the script; empty: the scene is fused.
  std::vector<std::string> obstacles;

  Precision precision = Precision::full;  // of the fused engine
  std::shared_ptr<const PairLaw> pair;
  std::vector<FixWallSdf*> walls;  // in the order of the script
  std::vector<LAMMPS_NS::FixWallGran*> primitive_walls;
  // Gravity and freeze: their post_force() completes the forces that others look at and keeps
  // their own records up to date.
  std::vector<LAMMPS_NS::Fix*> after_contacts;
  int moving_group = 0;                         // bit of the group that is integrated
  int frozen_group = 0;                         // bit of fix freeze; 0: none
  Vec3 acceleration = Vec3::Zero();             // m/s^2, sum of the above
  HeldForceFix* held_force = nullptr;           // fix couple/gas
  LAMMPS_NS::Fix* held_force_fix = nullptr;     // the same
  std::vector<LAMMPS_NS::Fix*> reneighbouring;  // fixes that ask for it at steps of their own
  std::vector<LAMMPS_NS::Fix*> streams;         // fix insert/stream (stream_grains.hpp)
  LAMMPS_NS::FixWallGran* mesh_wall = nullptr;  // LIGGGHTS allows one fix wall/gran of meshes
  // Meshes, their lists of grains, their contact histories and what moves them. Their pre_force()
  // deals meshes out to the ranks and builds the lists after a reneighbouring.
  std::vector<LAMMPS_NS::Fix*> mesh_fixes;
  // Those of them whose hooks are called in every step: they move, or record forces.
  std::vector<LAMMPS_NS::Fix*> live_mesh_fixes;

  bool known_pair_style = false;

  bool fused() const { return obstacles.empty(); }
  // Whether a pair style that the engine knows is in use at all.
  bool concerns_engine() const { return known_pair_style; }
  // One line for the user.
  std::string text() const;
};

// To be called after LAMMPS::init(), which sets up styles and their lists.
ScenePlan plan_scene(LAMMPS_NS::LAMMPS& lmp, Precision precision);

}  // namespace gasgrain::plugins
