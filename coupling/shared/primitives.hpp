// Plane, box, cylinder, cone, sphere and torus as solids: exact signed distance with its exact
// gradient. Points and lengths in m, lengths > 0 where nothing else is said.
#pragma once

#include "coupling/shared/signed_distance.hpp"

namespace gasgrain {

// The half space behind a plane is solid; `normal` is a unit vector into the gas.
struct Plane {
  Vec3 point;
  Vec3 normal;
};

struct Box {
  Vec3 center;
  Vec3 half_size;                // m, > 0
  Mat3 axes = Mat3::Identity();  // columns: unit vectors along the edges
};

// half_length = infinity: without ends.
struct Cylinder {
  Vec3 center;
  Vec3 axis;  // unit vector
  double radius;
  double half_length;
};

// Truncated cone; one radius may be zero.
struct Cone {
  Vec3 start;
  Vec3 axis;  // unit vector from start to end
  double length;
  double start_radius;
  double end_radius;
};

struct Torus {
  Vec3 center;
  Vec3 axis;           // unit vector
  double radius;       // of the ring's middle line
  double tube_radius;  // < radius
};

struct Sphere {
  Vec3 center;
  double radius;
};

// Distance and gradient at x. Where the nearest surface point is not unique (a sphere's centre, a
// cylinder's axis, the diagonal planes inside a box) the gradient is that of one of them.
DistanceSample measure(const Plane& plane, const Vec3& x);
DistanceSample measure(const Box& box, const Vec3& x);
DistanceSample measure(const Cylinder& cylinder, const Vec3& x);
DistanceSample measure(const Cone& cone, const Vec3& x);
DistanceSample measure(const Torus& torus, const Vec3& x);
DistanceSample measure(const Sphere& sphere, const Vec3& x);

// Locally nearest parts of the surface with |phi| < reach, see SignedDistance: from outside the one
// nearest place; inside of a box or of a cylinder with ends each face on its own.
void add_near_surfaces(const Box& box, const Vec3& x, double reach, NearSurfaces& found);
void add_near_surfaces(const Cylinder& cylinder, const Vec3& x, double reach, NearSurfaces& found);
void add_near_surfaces(const Cone& cone, const Vec3& x, double reach, NearSurfaces& found);

Shape make_shape(const Plane& plane);
Shape make_shape(const Box& box);
Shape make_shape(const Cylinder& cylinder);
Shape make_shape(const Cone& cone);
Shape make_shape(const Torus& torus);
Shape make_shape(const Sphere& sphere);

}  // namespace gasgrain
