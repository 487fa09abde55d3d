// One grain among SDF walls, without a host: the contacts of fix wall/sdf and the time integration
// of fix nve/sphere, for cases that measure the walls alone.
#pragma once

#include <functional>
#include <vector>

#include "coupling/shared/sampling.hpp"
#include "liggghts_plugins/sdf_wall.hpp"

namespace gasgrain::verification {

struct GrainMaterial {
  double radius = 1.0;           // m
  double mass = 1.0;             // kg
  double spring_constant = 1.0;  // N/m
  double restitution = 1.0;
  double friction = 0.0;
};

// Samples of `shape` with this spacing [m] around the box from -half_size to half_size [m].
Shape sampled(const Shape& shape, double half_size, double spacing, Interpolation interpolation);

class GrainFlight {
 public:
  GrainFlight(Shape wall, const GrainMaterial& material);

  Vec3 position = Vec3::Zero(), velocity = Vec3::Zero(), spin = Vec3::Zero();  // m, m/s, rad/s
  Vec3 gravity = Vec3::Zero();                                                 // m/s^2

  // Velocity Verlet: half a kick, drift, forces, half a kick.
  void step(double duration);

  bool touches() const { return touch_.touches; }
  double gap() const;             // to the nearest wall as contacts know it, m
  double kinetic_energy() const;  // of translation, J

 private:
  void find_forces(const plugins::TangentialStep& step);

  GrainMaterial material_;
  plugins::SdfWall wall_;
  LocalWalls walls_;
  plugins::WallTouch touch_;
  Vec3 displacement_ = Vec3::Zero();  // tangential spring, m
};

}  // namespace gasgrain::verification
