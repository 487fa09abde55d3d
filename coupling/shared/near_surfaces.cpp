#include "coupling/shared/near_surfaces.hpp"

#include <cmath>
#include <utility>

namespace gasgrain {

void add_near_walls(const SignedDistance& shape, const Vec3& x, double reach, NearWalls& found) {
  if (const auto* curved = dynamic_cast<const CurvedDistance*>(&shape)) {
    curved->add_near_walls(x, reach, found);
    return;
  }
  NearSurfaces surfaces;
  shape.add_near_surfaces(x, reach, surfaces);
  for (int n = 0; n < surfaces.count; ++n) found.add(NearWall(surfaces.surface[n]));
}

void add_without_curvature(const CurvedDistance& shape, const Vec3& x, double reach,
                           NearSurfaces& found) {
  NearWalls walls;
  shape.add_near_walls(x, reach, walls);
  for (int n = 0; n < walls.count; ++n) found.add(walls.surface[n]);
}

void add_distinct(const NearWall& wall, NearWalls& found) {
  for (int n = 0; n < found.count; ++n) {
    NearWall& other = found.surface[n];
    const double lengths = other.gradient.norm() * wall.gradient.norm();
    if (other.gradient.dot(wall.gradient) < same_normal * lengths) continue;
    if (std::abs(wall.distance) < std::abs(other.distance)) other = wall;
    return;
  }
  found.add(wall);
}

NearWalls ball_contacts(const SignedDistance& shape, const DistanceSample& nearest, const Vec3& x,
                        double reach) {
  NearWalls result;
  if (nearest.distance <= 0) {
    result.add(NearWall(nearest));
    return result;
  }
  NearWalls all;
  add_near_walls(shape, x, reach, all);
  for (int n = 0; n < all.count; ++n)
    if (all.surface[n].distance > 0 && all.surface[n].distance < reach)
      add_distinct(all.surface[n], result);
  for (int n = 1; n < result.count; ++n)
    if (result.surface[n].distance < result.surface[0].distance)
      std::swap(result.surface[n], result.surface[0]);
  return result;
}

}  // namespace gasgrain
