#include "liggghts_plugins/engine/primitive_wall_loads.hpp"

#include <atom.h>
#include <fix_wall_gran.h>
#include <primitive_wall.h>

#include <span>

#include "liggghts_plugins/private_member.hpp"

namespace gasgrain::plugins {

using LAMMPS_NS::PrimitiveWall;

struct ListedGrains {
  using Member = ScalarContainer<int> PrimitiveWall::*;
  friend Member private_member(ListedGrains);
};
template struct GrantAccess<ListedGrains, &PrimitiveWall::neighlist>;

namespace {

using Column = Eigen::Map<Vec3>;
using ConstColumn = Eigen::Map<const Vec3>;

constexpr int no_virial = 0;

}  // namespace

bool computes_loads_only(LAMMPS_NS::FixWallGran& wall) {
  return !wall.store_force() && !wall.store_force_contact() && !wall.store_force_contact_stress() &&
         !wall.store_sum_normal_force() && !wall.compute_wall_gran_local() &&
         wall.heattransfer_flag() == 0 && !wall.fix_rigid();
}

void keep_near_grains(LAMMPS_NS::FixWallGran& wall, LAMMPS_NS::Atom& atom, double reach) {
  static_cast<LAMMPS_NS::Fix&>(wall).pre_force(no_virial);  // builds the list if it is out of date
  PrimitiveWall& primitive = *wall.primitiveWall();
  int* listed = nullptr;
  const int count = primitive.getNeighbors(listed);
  std::vector<int> near;
  Vec3 to_wall;
  for (const int i : std::span(listed, count))
    if (primitive.resolveContact(atom.x[i], atom.radius[i], to_wall.data()) < reach)
      near.push_back(i);
  auto& list = primitive.*private_member(ListedGrains());
  list.clearContainer();
  for (const int i : near) list.add(i);
}

void compute_wall_loads(std::vector<GrainLoad>& loads, LAMMPS_NS::FixWallGran& wall,
                        LAMMPS_NS::Atom& atom, GrainLoop& loop) {
  LAMMPS_NS::Fix& fix = wall;
  int* near = nullptr;
  const int count = wall.primitiveWall()->getNeighbors(near);
  for (int n = 0; n < count; ++n) {
    const int i = near[n];
    Column(atom.x[i]) = ConstColumn(loop.grain(i).position);
    Column(atom.v[i]) = ConstColumn(loop.grain(i).velocity);
    Column(atom.omega[i]) = ConstColumn(loop.spin(i).velocity);
    Column(atom.f[i]).setZero();
    Column(atom.torque[i]).setZero();
  }
  fix.post_force(no_virial);
  loads.clear();
  for (int n = 0; n < count; ++n) {
    const int i = near[n];
    const ConstColumn force(atom.f[i]), torque(atom.torque[i]);
    if (!force.isZero(0.0) || !torque.isZero(0.0)) loads.push_back({i, force, torque});
  }
}

}  // namespace gasgrain::plugins
