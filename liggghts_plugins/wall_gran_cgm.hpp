// `fix wall/gran model cgm`: the coarse-grain contact law against LIGGGHTS's primitive and mesh
// walls. Properties of the pair (grain type, wall type); the ratio l is the grain's.
#pragma once

#include <granular_wall.h>
#include <pointers.h>

#include "liggghts_plugins/contact_properties.hpp"
#include "liggghts_plugins/contact_settings.hpp"
#include "liggghts_plugins/grain_wall.hpp"

namespace gasgrain::plugins {

class WallGranCgm : public LIGGGHTS::Walls::IGranularWall,
                    protected LAMMPS_NS::Pointers,
                    public GrainWall {
 public:
  WallGranCgm(LAMMPS_NS::LAMMPS* liggghts, LAMMPS_NS::FixWallGran* parent, int64_t variant);

  void settings(int argument_count, char** arguments,
                LIGGGHTS::IContactHistorySetup* history) override;
  void init_granular() override;
  bool checkSurfaceIntersect(LIGGGHTS::ContactModels::SurfacesIntersectData&) override {
    return true;  // spheres: the caller has decided
  }
  void compute_force(LAMMPS_NS::FixWallGran* wall,
                     LIGGGHTS::ContactModels::SurfacesIntersectData& contact, bool touching,
                     double* wall_velocity, LAMMPS_NS::FixMeshSurface* mesh_fix, int mesh_index,
                     LAMMPS_NS::TriMesh* mesh, int triangle) override;
  int get_history_offset(std::string) override { return -1; }
  bool contact_match(const std::string kind, const std::string model) override;

  std::string wall_name() const override;
  Vec3 take_impulse() override;
  bool surface_moves() const override { return surface_moves_; }

 private:
  struct Forces {
    Vec3 force;   // on the grain, N
    Vec3 torque;  // N m
  };
  Forces forces(const LAMMPS_NS::FixWallGran& wall,
                const LIGGGHTS::ContactModels::SurfacesIntersectData& contact, const Vec3& n,
                const double* wall_velocity);
  void enter_present_step();
  void close_step();

  LAMMPS_NS::FixWallGran* parent_;
  int64_t variant_;
  ContactSettings settings_;
  bool own_exponent_ = false;
  int history_offset_ = -1;
  GrainContactTable contacts_;

  // Force on the wall in the step that is being summed up.
  WallImpulse impulse_;
  Vec3 step_force_ = Vec3::Zero();
  LAMMPS_NS::bigint step_ = -1;
  bool setup_step_ = true;
  bool step_closed_ = true;
  bool surface_moves_ = false;  // where it was touched
};

}  // namespace gasgrain::plugins
