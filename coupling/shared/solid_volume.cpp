// Volume by octree: a cube whose centre is farther from the surface than its half diagonal is all
// solid or all gas; the others are halved, and the last ones are cut by the plane phi + g.(x-c) =
// 0:
//
//   solid share = 1/2 - phi / (edge (|g_x| + |g_y| + |g_z|)),   limited to [0, 1]
//
// exact for planes along the grid, and second order in the last edge for smooth surfaces since the
// errors of oblique cuts cancel in the sum (the share is odd in phi).
#include "coupling/shared/solid_volume.hpp"

#include <algorithm>
#include <cmath>

namespace gasgrain {

namespace {

double solid_share(const SignedDistance& shape, const Vec3& center, double edge, int halvings) {
  const DistanceSample at_center = shape.sample(center);
  const double half_diagonal = 0.5 * std::sqrt(3.0) * edge;
  if (std::abs(at_center.distance) >= half_diagonal) return at_center.distance < 0 ? 1.0 : 0.0;
  if (halvings == 0) {
    const double reach = edge * at_center.gradient.lpNorm<1>();
    if (reach == 0.0) return at_center.distance < 0 ? 1.0 : 0.0;
    return std::clamp(0.5 - at_center.distance / reach, 0.0, 1.0);
  }
  double sum = 0.0;
  for (int octant = 0; octant < 8; ++octant) {
    const Vec3 side(octant & 1 ? 1 : -1, octant & 2 ? 1 : -1, octant & 4 ? 1 : -1);
    sum += solid_share(shape, center + 0.25 * edge * side, 0.5 * edge, halvings - 1);
  }
  return sum / 8.0;
}

}  // namespace

double solid_volume(const SignedDistance& shape, const VolumeGrid& grid) {
  double sum = 0.0;
  for (int k = 0; k < grid.cells[2]; ++k) {
    for (int j = 0; j < grid.cells[1]; ++j) {
      for (int i = 0; i < grid.cells[0]; ++i) {
        const Vec3 center = grid.lower + grid.spacing * Vec3(i + 0.5, j + 0.5, k + 0.5);
        sum += solid_share(shape, center, grid.spacing, grid.halvings);
      }
    }
  }
  return sum * std::pow(grid.spacing, 3);
}

}  // namespace gasgrain
