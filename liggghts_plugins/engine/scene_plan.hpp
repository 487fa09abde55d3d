// What the fused engine takes over in a scene, or why it does not.
#pragma once

#include <string>
#include <vector>

#include "coupling/shared/vec3.hpp"
#include "liggghts_plugins/engine/held_force.hpp"

namespace LAMMPS_NS {  // NOLINT(readability-identifier-naming): the name of LIGGGHTS
class Fix;
class FixWallGran;
class LAMMPS;
}  // namespace LAMMPS_NS

namespace gasgrain::plugins {

class FixWallSdf;
class PairGranCgm;

struct ScenePlan {
  // What is not understood, by style as in the script; empty: the scene is fused.
  std::vector<std::string> obstacles;

  PairGranCgm* pair = nullptr;
  std::vector<FixWallSdf*> walls;  // in the order of the script
  std::vector<LAMMPS_NS::FixWallGran*> primitive_walls;
  std::vector<LAMMPS_NS::Fix*> gravity;         // their post_force() keeps their energy up to date
  Vec3 acceleration = Vec3::Zero();             // m/s^2, sum of the above
  HeldForceFix* held_force = nullptr;           // fix couple/gas
  LAMMPS_NS::Fix* held_force_fix = nullptr;     // the same
  std::vector<LAMMPS_NS::Fix*> reneighbouring;  // fixes that ask for it at steps of their own

  bool fused() const { return obstacles.empty(); }
  // Whether a pair style that the engine knows is in use at all.
  bool concerns_engine() const { return pair != nullptr; }
  // One line for the user.
  std::string text() const;
};

// To be called after LAMMPS::init(), which sets up styles and their lists.
ScenePlan plan_scene(LAMMPS_NS::LAMMPS& lmp);

}  // namespace gasgrain::plugins
