// How a sampled field finds the walls around a ball.
//
// The distance d(x) of a wall is that to its foot f, the place on the surface phi = 0 nearest to x:
//
//   phi(f) = 0,   x - f = d n,   n = grad phi/|grad phi| at f
//   grad d = n,   second derivatives of d = S (1 + d S)^-1,   S: curvatures of the surface at f
//
// (Gilbarg and Trudinger, Elliptic Partial Differential Equations of Second Order, ch. 14.6). It is
// used instead of phi(x) although it costs more, since it is the same function whether or not other
// walls are near: a ball that touches two walls has its centre where both are equally near, and
// there phi has a kink, which interpolation rounds off. One potential for each wall keeps the
// energy of a grain that goes in and out of edges.
//
// f is found from where phi points to (surface_foot.cpp).
//
// Near a kink (|grad phi| < 1) the field is looked at a little way off in six directions, each wall
// seen there is followed to its foot, and feet with the same normal are one.
//
// Linear interpolation has no S. There the share -dS of a move that is seen to be left corrects the
// length of the next one (Steffensen), phi(x) itself is taken away from kinks, and every result
// holds at x alone.
#include <algorithm>
#include <cmath>

#include "coupling/shared/near_surfaces.hpp"
#include "coupling/shared/sampled_distance.hpp"
#include "coupling/shared/surface_foot.hpp"

namespace gasgrain {

namespace {

constexpr double kink = 0.002;      // |grad phi| differs by more from 1: a kink is near
constexpr double clean = 0.98;      // |grad phi| above: belongs to one wall
constexpr double look_aside = 2.5;  // spacings
constexpr double missed = 1.0;      // spacings that the nearest wall seems to be farther away

constexpr double smallest_gradient = 0.3;  // |grad phi| of a place to start from
constexpr int most_linear_moves = 6;
constexpr double close_to_linear_foot = 0.005;  // spacings that a foot may lie aside of x
constexpr double surface_error = 1.0;   // spacings by which a foot before it is mended may miss
constexpr double largest_share = 0.75;  // of a move that may seem to be left

bool has_normal_of(const NearWalls& walls, const Vec3& gradient) {
  for (int n = 0; n < walls.count; ++n)
    if (walls.surface[n].gradient.dot(gradient) > same_normal * gradient.norm()) return true;
  return false;
}

// Whether the field shows no edge between two walls: a hollow hardly narrower than the ball, which
// rests on it along an arc. Between walls with an edge the surface would bulge away from the ball
// by the height of a triangle.
bool are_one_hollow(const SignedDistance& field, const Vec3& x, const NearWall& one,
                    const NearWall& other) {
  constexpr double least_bulge = 0.5;  // of that of two flat walls
  const Vec3 between = (one.gradient + other.gradient).normalized();
  const double distance = 0.5 * (one.distance + other.distance);
  const double flat_bulge = distance * (1.0 - one.gradient.dot(between));
  return field.distance(x - distance * between) < least_bulge * flat_bulge;
}

// Adds a wall that is no part of the others, or replaces a farther one that it is part of.
void add_apart(const SignedDistance& field, const Vec3& x, const NearWall& wall, NearWalls& walls) {
  for (int n = 0; n < walls.count; ++n) {
    NearWall& other = walls.surface[n];
    if (wall.gradient.dot(other.gradient) < same_normal && !are_one_hollow(field, x, wall, other))
      continue;
    if (std::abs(wall.distance) < std::abs(other.distance)) other = wall;
    return;
  }
  walls.add(wall);
}

bool has_unit_gradient(const DistanceSample& sample) {
  return std::abs(sample.gradient.norm() - 1.0) <= kink;
}

}  // namespace

void SampledDistance::add_near_walls(const Vec3& x, double reach, NearWalls& found) const {
  const DistanceSample nearest = sample(x);
  if (std::abs(nearest.distance) >= reach + data_.spacing) return;
  const NearWalls walls = walls_around(x, nearest);
  if (walls.count == 0 && std::abs(nearest.distance) < reach) found.add(NearWall(nearest));
  for (int n = 0; n < walls.count; ++n)
    if (std::abs(walls.surface[n].distance) < reach) found.add(walls.surface[n]);
}

// None when they cannot be resolved.
NearWalls SampledDistance::walls_around(const Vec3& x, const DistanceSample& nearest) const {
  NearWalls walls;
  const bool linear = data_.interpolation == Interpolation::linear;
  const bool at_kink = !has_unit_gradient(nearest) || (linear && kink_between_cells(x, nearest));
  if (!linear) {
    if (const auto wall = wall_below(x, x, nearest)) walls.add(*wall);
  }
  if (!at_kink) return walls;
  for (int d = 0; d < 3; ++d) {
    for (const double side : {-look_aside, look_aside}) {
      const Vec3 at = x + side * data_.spacing * Vec3::Unit(d);
      const DistanceSample there = sample(at);
      if (there.gradient.norm() < clean || has_normal_of(walls, there.gradient)) continue;
      const std::optional<NearWall> wall = wall_below(x, at, there);
      if (wall)
        add_apart(*this, x, *wall, walls);
      else if (linear)
        return {};
    }
  }
  if (linear) return walls;
  for (int n = 0; n < walls.count; ++n)
    if (std::abs(walls.surface[n].distance) < std::abs(nearest.distance) + missed * data_.spacing)
      return walls;
  return {};  // the nearest wall is not among them
}

// The wall that the field `there`, at a place `at` near x, belongs to, if its foot is resolved.
std::optional<NearWall> SampledDistance::wall_below(const Vec3& x, const Vec3& at,
                                                    const DistanceSample& there) const {
  if (there.gradient.norm() < smallest_gradient) return std::nullopt;
  const Vec3 start = at - there.distance * there.gradient.normalized();
  return data_.interpolation == Interpolation::linear ? wall_below_linear(x, start)
                                                      : wall_at_foot(*this, x, start);
}

// A kink that lies along the sides of cells shows in no cell of the linear interpolation.
bool SampledDistance::kink_between_cells(const Vec3& x, const DistanceSample& nearest) const {
  constexpr double near = 0.25;  // spacings
  for (int d = 0; d < 3; ++d)
    for (const double side : {-near, near})
      if (sample(x + side * data_.spacing * Vec3::Unit(d)).gradient.dot(nearest.gradient) <
          same_normal * nearest.gradient.squaredNorm())
        return true;
  return false;
}

std::optional<NearWall> SampledDistance::wall_below_linear(const Vec3& x, Vec3 foot) const {
  Vec3 aside_before = Vec3::Zero();
  double length = 1.0;  // of the move, in units of the part aside
  for (int move = 0; move < most_linear_moves; ++move) {
    const DistanceSample on_surface = sample(foot);
    if (std::abs(on_surface.distance) > surface_error * data_.spacing ||
        on_surface.gradient.norm() < clean)
      return std::nullopt;
    const Vec3 n = on_surface.gradient.normalized();
    foot -= on_surface.distance * n;
    const double distance = (x - foot).dot(n);
    const Vec3 aside = x - foot - distance * n;
    if (aside.norm() < close_to_linear_foot * data_.spacing)
      return NearWall(DistanceSample{distance, n});
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
