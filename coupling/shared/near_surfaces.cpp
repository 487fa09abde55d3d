// Several contacts of one ball: the list that the shape gives, without those beyond the ball's
// radius and without doubles; and how a sampled field finds them.
//
// A ball that touches two walls has its centre where both are equally near: there phi has a kink
// (|grad phi| < 1), and its samples on either side belong to one wall each. So near a kink the
// field is looked at a little way off in six directions, and for each wall seen there the foot
// below x is found: the place f on the surface where x - f has no part a along it. Moving f by a
// leaves the share -d/R of it (d: distance, R: radius of curvature, > 0 where the wall is convex);
// the share that is seen corrects the length of the next move (Steffensen), so that walls as curved
// as the ball need three or four looks too. Where |grad phi| = 1 there is no kink within reach of
// the interpolation and the sample at x is all. So it is when a wall near a kink cannot be
// resolved, since its foot lies in an edge.
#include "coupling/shared/near_surfaces.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "coupling/shared/sampled_distance.hpp"

namespace gasgrain {

namespace {

constexpr double kink = 0.002;      // |grad phi| differs by more from 1: a kink is near
constexpr double clean = 0.98;      // |grad phi| above: belongs to one wall
constexpr double look_aside = 2.5;  // spacings
constexpr int most_moves = 6;
constexpr double close_to_foot = 0.005;  // spacings that a foot may lie aside of x
constexpr double surface_error = 1.0;    // spacings by which a foot before it is mended may miss
constexpr double largest_share = 0.75;   // of a move that may seem to be left

bool has_normal_of(const NearSurfaces& walls, const Vec3& gradient) {
  for (int n = 0; n < walls.count; ++n)
    if (walls.surface[n].gradient.dot(gradient) > same_normal * gradient.norm()) return true;
  return false;
}

bool has_unit_gradient(const DistanceSample& sample) {
  return std::abs(sample.gradient.norm() - 1.0) <= kink;
}

// A sampled field of continuous gradient that has but one surface within reach.
bool is_far_from_kinks(const SignedDistance& shape, const DistanceSample& nearest) {
  const auto* field = dynamic_cast<const SampledDistance*>(&shape);
  return field && field->data().interpolation == Interpolation::quadratic &&
         has_unit_gradient(nearest);
}

// Replaces one with the same normal if nearer, else adds.
void add_distinct(const DistanceSample& sample, int from, NearSurfaces& found) {
  for (int n = from; n < found.count; ++n) {
    DistanceSample& other = found.surface[n];
    const double lengths = other.gradient.norm() * sample.gradient.norm();
    if (other.gradient.dot(sample.gradient) < same_normal * lengths) continue;
    if (std::abs(sample.distance) < std::abs(other.distance)) other = sample;
    return;
  }
  found.add(sample);
}

}  // namespace

NearSurfaces ball_contacts(const SignedDistance& shape, const DistanceSample& nearest,
                           const Vec3& x, double radius) {
  NearSurfaces result;
  if (nearest.distance <= 0) {
    result.add(nearest);
    return result;
  }
  if (is_far_from_kinks(shape, nearest)) {  // known without a second look
    if (nearest.distance < radius) result.add(nearest);
    return result;
  }
  NearSurfaces all;
  shape.add_near_surfaces(x, radius, all);
  for (int n = 0; n < all.count; ++n)
    if (all.surface[n].distance > 0 && all.surface[n].distance < radius)
      add_distinct(all.surface[n], 0, result);
  for (int n = 1; n < result.count; ++n)
    if (result.surface[n].distance < result.surface[0].distance)
      std::swap(result.surface[n], result.surface[0]);
  return result;
}

void SampledDistance::add_near_surfaces(const Vec3& x, double reach, NearSurfaces& found) const {
  const DistanceSample nearest = sample(x);
  if (std::abs(nearest.distance) >= reach + data_.spacing) return;
  const bool at_kink = !has_unit_gradient(nearest) || kink_between_cells(x, nearest);
  const NearSurfaces walls = at_kink ? walls_around(x) : NearSurfaces{};
  if (walls.count == 0 && std::abs(nearest.distance) < reach) found.add(nearest);
  for (int n = 0; n < walls.count; ++n)
    if (std::abs(walls.surface[n].distance) < reach) found.add(walls.surface[n]);
}

// The walls seen in six directions; none when one of them cannot be resolved.
NearSurfaces SampledDistance::walls_around(const Vec3& x) const {
  NearSurfaces walls;
  for (int d = 0; d < 3; ++d) {
    for (const double side : {-look_aside, look_aside}) {
      const Vec3 at = x + side * data_.spacing * Vec3::Unit(d);
      const DistanceSample there = sample(at);
      if (there.gradient.norm() < clean || has_normal_of(walls, there.gradient)) continue;
      const std::optional<DistanceSample> wall = wall_below(x, at, there);
      if (!wall) return {};
      add_distinct(*wall, 0, walls);
    }
  }
  return walls;
}

// A kink that lies along the sides of cells shows in no cell of the linear interpolation.
bool SampledDistance::kink_between_cells(const Vec3& x, const DistanceSample& nearest) const {
  if (data_.interpolation != Interpolation::linear) return false;
  constexpr double near = 0.25;  // spacings
  for (int d = 0; d < 3; ++d)
    for (const double side : {-near, near})
      if (sample(x + side * data_.spacing * Vec3::Unit(d)).gradient.dot(nearest.gradient) <
          same_normal * nearest.gradient.squaredNorm())
        return true;
  return false;
}

// Distance and normal at x of the wall that the field `there` belongs to, if its foot is resolved.
std::optional<DistanceSample> SampledDistance::wall_below(const Vec3& x, const Vec3& at,
                                                          const DistanceSample& there) const {
  Vec3 foot = at - there.distance * there.gradient.normalized();
  Vec3 aside_before = Vec3::Zero();
  double length = 1.0;  // of the move, in units of the part aside
  for (int move = 0; move < most_moves; ++move) {
    const DistanceSample on_surface = sample(foot);
    if (std::abs(on_surface.distance) > surface_error * data_.spacing ||
        on_surface.gradient.norm() < clean)
      return std::nullopt;
    const Vec3 n = on_surface.gradient.normalized();
    foot -= on_surface.distance * n;
    const double distance = (x - foot).dot(n);
    const Vec3 aside = x - foot - distance * n;
    if (aside.norm() < close_to_foot * data_.spacing) return DistanceSample{distance, n};
    if (move > 0) {
      const double left = aside.dot(aside_before) / aside_before.squaredNorm();
      length /= 1.0 - std::min(left, largest_share);
    }
    foot += length * aside;
    aside_before = aside;
  }
  return std::nullopt;
}

}  // namespace gasgrain
