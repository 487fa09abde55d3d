// What the fused engine has to call of the fixes that belong to meshes.
#pragma once

namespace LAMMPS_NS {  // NOLINT(readability-identifier-naming): the name of LIGGGHTS
class Fix;
}

namespace gasgrain::plugins {

enum class MeshFixRole {
  none,     // no such fix, or one that does more than the engine understands
  still,    // something to do at reneighbourings only: pre_force()
  live,     // hooks in every step: it moves a mesh, moves itself or records forces
  variable  // as live, but follows variables, which may look at grains between reneighbourings
};

// Of a mesh/surface (planar, stress), neighlist/mesh, contacthistory/mesh or move/mesh.
MeshFixRole mesh_fix_role(LAMMPS_NS::Fix& fix);

}  // namespace gasgrain::plugins
