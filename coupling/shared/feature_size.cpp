// Rays through the shape by sphere tracing: a step of |phi| cannot miss a surface (Hart 1996). Rays
// begin half a spacing from the surface, so that walls thinner than that show as wrong sign.
//
// Of all rays the thinnest thousandth is left out: a ray that grazes an edge meets it at once.
#include "coupling/shared/feature_size.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "coupling/shared/known_distance.hpp"

namespace gasgrain {

namespace {

constexpr std::size_t most_rays = 20000;
constexpr double left_out = 1e-3;

// Length of the ray from x along n within the solid (sign -1) or the gas (sign 1).
double free_length(const SignedDistance& shape, const Vec3& x, const Vec3& n, double sign,
                   double spacing, double length) {
  constexpr double whole_step = 0.99;  // of |phi|: beyond it the side would not be known
  double way = 0.5 * spacing;
  KnownDistance last{x, 0.0};
  while (way < length) {
    const Vec3 place = x + way * n;
    last = {place, distance_near(shape, place, last)};
    const double phi = sign * last.distance;
    if (phi <= 0) return way;
    way += std::max(whole_step * phi, 0.02 * spacing);
  }
  return length;
}

double low_quantile(std::vector<double>& values, double otherwise) {
  if (values.empty()) return otherwise;
  const auto n = static_cast<std::ptrdiff_t>(left_out * static_cast<double>(values.size()));
  std::nth_element(values.begin(), values.begin() + n, values.end());
  return values[n];
}

}  // namespace

FeatureSize feature_size(const SignedDistance& shape, const SampledDistance& field, double length) {
  const double spacing = field.data().spacing;
  std::vector<Vec3> surface;  // one point per brick near it
  const Index3& bricks = field.data().bricks;
  for (int k = 0; k < bricks[2]; ++k) {
    for (int j = 0; j < bricks[1]; ++j) {
      for (int i = 0; i < bricks[0]; ++i) {
        if (field.brick({i, j, k}).slot < 0) continue;
        const Vec3 centre = field.position({i, j, k}, {1, 1, 1}) + Vec3::Constant(0.5 * spacing);
        if (std::abs(field.distance(centre)) < 2 * spacing) surface.push_back(centre);
      }
    }
  }
  const std::size_t stride = surface.size() / most_rays + 1;
  FeatureSize result;
  std::vector<double> walls, gaps;
  for (std::size_t n = 0; n < surface.size(); n += stride) {
    const DistanceSample near = shape.sample(surface[n]);
    if (near.gradient.norm() < 0.9) continue;
    const Vec3 normal = near.gradient.normalized(), foot = surface[n] - near.distance * normal;
    if (std::abs(shape.distance(foot)) > 0.1 * spacing) continue;
    walls.push_back(free_length(shape, foot, -normal, -1.0, spacing, length));
    gaps.push_back(free_length(shape, foot, normal, 1.0, spacing, length));
    result.thin_share += std::min(walls.back(), gaps.back()) < 2 * spacing;
  }
  result.rays = walls.size();
  if (!walls.empty()) result.thin_share /= static_cast<double>(walls.size());
  result.thinnest_wall = low_quantile(walls, length);
  result.narrowest_gap = low_quantile(gaps, length);
  return result;
}

}  // namespace gasgrain
