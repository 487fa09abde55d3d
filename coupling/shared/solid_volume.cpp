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
#include <numeric>
#include <vector>

#include "coupling/shared/known_distance.hpp"
#include "coupling/shared/parallel_for.hpp"

namespace gasgrain {

namespace {

// `parent`: what is known of the cube that this one is an octant of.
double solid_share(const SignedDistance& shape, const Vec3& center, double edge, int halvings,
                   const KnownDistance& parent) {
  const KnownDistance own{center, distance_near(shape, center, parent)};
  const double half_diagonal = 0.5 * std::sqrt(3.0) * edge;
  if (std::abs(own.distance) >= half_diagonal) return own.distance < 0 ? 1.0 : 0.0;
  if (halvings == 0) {
    const double reach = edge * shape.sample(center).gradient.lpNorm<1>();
    if (reach == 0.0) return own.distance < 0 ? 1.0 : 0.0;
    return std::clamp(0.5 - own.distance / reach, 0.0, 1.0);
  }
  double sum = 0.0;
  for (int octant = 0; octant < 8; ++octant) {
    const Vec3 side(octant & 1 ? 1 : -1, octant & 2 ? 1 : -1, octant & 4 ? 1 : -1);
    sum += solid_share(shape, center + 0.25 * edge * side, 0.5 * edge, halvings - 1, own);
  }
  return sum / 8.0;
}

double solid_cubes_of_row(const SignedDistance& shape, const VolumeGrid& grid, int j, int k) {
  double sum = 0.0;
  const KnownDistance nothing{grid.lower, 0.0};
  for (int i = 0; i < grid.cells[0]; ++i) {
    const Vec3 center = grid.lower + grid.spacing * Vec3(i + 0.5, j + 0.5, k + 0.5);
    sum += solid_share(shape, center, grid.spacing, grid.halvings, nothing);
  }
  return sum;
}

}  // namespace

double solid_volume(const SignedDistance& shape, const VolumeGrid& grid, int threads) {
  std::vector<double> row(static_cast<std::size_t>(grid.cells[1]) * grid.cells[2]);
  const auto sum_row = [&](std::size_t n) {
    const int j = static_cast<int>(n % grid.cells[1]), k = static_cast<int>(n / grid.cells[1]);
    row[n] = solid_cubes_of_row(shape, grid, j, k);
  };
  parallel_for(row.size(), threads, sum_row, [](std::size_t) {});
  return std::accumulate(row.begin(), row.end(), 0.0) * std::pow(grid.spacing, 3);
}

}  // namespace gasgrain
