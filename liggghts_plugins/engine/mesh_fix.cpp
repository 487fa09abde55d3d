#include "liggghts_plugins/engine/mesh_fix.hpp"

#include <fix_mesh_surface.h>
#include <fix_move_mesh.h>
#include <mesh_mover_linear.h>
#include <mesh_mover_rotation.h>
#include <tri_mesh.h>

#include <string>

#include "liggghts_plugins/private_member.hpp"

namespace gasgrain::plugins {

using LAMMPS_NS::FixMeshSurface;
using LAMMPS_NS::FixMoveMesh;

struct SurfaceVelocityX {
  using Member = char* FixMeshSurface::*;
  friend Member private_member(SurfaceVelocityX);
};
struct SurfaceVelocityY {
  using Member = char* FixMeshSurface::*;
  friend Member private_member(SurfaceVelocityY);
};
struct SurfaceVelocityZ {
  using Member = char* FixMeshSurface::*;
  friend Member private_member(SurfaceVelocityZ);
};
struct SurfaceSpin {
  using Member = char* FixMeshSurface::*;
  friend Member private_member(SurfaceSpin);
};
struct Mover {
  using Member = LAMMPS_NS::MeshMover* FixMoveMesh::*;
  friend Member private_member(Mover);
};
template struct GrantAccess<SurfaceVelocityX, &FixMeshSurface::vSurfStrX_>;
template struct GrantAccess<SurfaceVelocityY, &FixMeshSurface::vSurfStrY_>;
template struct GrantAccess<SurfaceVelocityZ, &FixMeshSurface::vSurfStrZ_>;
template struct GrantAccess<SurfaceSpin, &FixMeshSurface::omegaStr_>;
template struct GrantAccess<Mover, &FixMoveMesh::move_>;

namespace {

bool follows_variables(FixMeshSurface& mesh) {
  return mesh.*private_member(SurfaceVelocityX()) || mesh.*private_member(SurfaceVelocityY()) ||
         mesh.*private_member(SurfaceVelocityZ()) || mesh.*private_member(SurfaceSpin());
}

bool follows_variables(FixMoveMesh& move) {
  const LAMMPS_NS::MeshMover* mover = move.*private_member(Mover());
  return dynamic_cast<const LAMMPS_NS::MeshMoverLinearVariable*>(mover) ||
         dynamic_cast<const LAMMPS_NS::MeshMoverRotateVariable*>(mover);
}

}  // namespace

MeshFixRole mesh_fix_role(LAMMPS_NS::Fix& fix) {
  const std::string style = fix.style;
  if (style == "neighlist/mesh" || style == "contacthistory/mesh") return MeshFixRole::still;
  if (style == "move/mesh")
    return follows_variables(static_cast<FixMoveMesh&>(fix)) ? MeshFixRole::variable
                                                             : MeshFixRole::live;
  const bool records = style == "mesh/surface/stress";
  if (!records && style != "mesh/surface" && style != "mesh/surface/planar")
    return MeshFixRole::none;
  auto& mesh = static_cast<FixMeshSurface&>(fix);
  if (follows_variables(mesh)) return MeshFixRole::variable;
  return records || mesh.mesh()->isMoving() ? MeshFixRole::live : MeshFixRole::still;
}

}  // namespace gasgrain::plugins
