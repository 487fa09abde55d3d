#include "liggghts_plugins/grain_wall.hpp"

#include <map>
#include <utility>

namespace gasgrain::plugins {

namespace {

std::map<const LAMMPS_NS::LAMMPS*, std::vector<GrainWall*>>& walls() {
  static std::map<const LAMMPS_NS::LAMMPS*, std::vector<GrainWall*>> list;
  return list;
}

}  // namespace

Vec3 WallImpulse::take() {
  return std::exchange(impulse_, Vec3::Zero());
}

GrainWall::GrainWall(LAMMPS_NS::LAMMPS& lmp) : lmp_(lmp) {
  walls()[&lmp].push_back(this);
}

GrainWall::~GrainWall() {
  std::erase(walls()[&lmp_], this);
}

std::vector<GrainWall*> grain_walls(LAMMPS_NS::LAMMPS& lmp) {
  return walls()[&lmp];
}

}  // namespace gasgrain::plugins
