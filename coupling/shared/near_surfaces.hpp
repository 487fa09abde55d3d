// The walls near a place with their curvature, and the contacts of a ball with a shape.
#pragma once

#include <array>

#include "coupling/shared/signed_distance.hpp"

namespace gasgrain {

// Normals that differ by less than this angle (20 degrees, its cosine) are one contact.
inline constexpr double same_normal = 0.94;

// A locally nearest part of the surface, seen from one point.
struct NearWall : DistanceSample {
  double way = 0.0;  // m; so far around the point gradient and curvature tell the distance; 0: only
                     // there, and the curvature is not set
  bool foot_found = true;  // false: the search was given up at the nearest place so far
  Mat3 curvature;          // second derivatives of the distance, 1/m

  NearWall() = default;
  explicit NearWall(const DistanceSample& sample) : DistanceSample(sample) {}
};

struct NearWalls {
  static constexpr int most = NearSurfaces::most;
  int count = 0;
  std::array<NearWall, most> surface;

  // Further ones than `most` are dropped.
  void add(const NearWall& wall) {
    if (count < most) surface[count++] = wall;
  }
};

// What shapes offer besides SignedDistance that know how their surface bends, or whose parts do:
// the same surfaces as add_near_surfaces().
class CurvedDistance {
 public:
  virtual ~CurvedDistance() = default;
  virtual void add_near_walls(const Vec3& x, double reach, NearWalls& found) const = 0;
};

// Adds the near surfaces of any shape.
void add_near_walls(const SignedDistance& shape, const Vec3& x, double reach, NearWalls& found);
// add_near_surfaces() of such shapes.
void add_without_curvature(const CurvedDistance& shape, const Vec3& x, double reach,
                           NearSurfaces& found);

// Replaces a wall with the same normal if nearer, else adds.
void add_distinct(const NearWall& wall, NearWalls& found);

// The surfaces with 0 < phi < reach that a ball at x may touch, each with a normal of its own, the
// nearest first. `nearest` is shape.sample(x). When x itself is within the solid the nearest alone.
NearWalls ball_contacts(const SignedDistance& shape, const DistanceSample& nearest, const Vec3& x,
                        double reach);

}  // namespace gasgrain
