// The foot f of a point x on the surface phi = 0 by Newton's method: a move along the surface by
// (1 + d S)^-1 times the part of x - f that is aside of the normal, and back onto it by phi. The
// move follows the surface's curvature, so that it ends on the surface but for terms of third
// order: in a flat valley of |x - f| the second ones would decide what seems to be downhill.
//
// S jumps from cell to cell, and 1 + d S may be small or negative, so a move that would lead away
// from x is shortened (trust region) and one where 1 + d S is too small goes downhill only. So
// every search ends at a foot: at a minimum of |x - f|, not at a maximum, which is the farthest
// place of a hollow.
//
// In a hollow about as narrow as the ball 1 + d S almost vanishes: the surface is nearly a circle
// about x, and the errors of the field make many feet on it, some of them less than a cell apart.
// There the circle is looked at all around, the search begins again at each low place, and the
// nearest foot counts: the least of all distances is continuous, while the choice among feet that
// a single search makes is not, and heats the ball.
//
// Source of the trust region: Nocedal and Wright, Numerical Optimization, ch. 4.
#include "coupling/shared/surface_foot.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace gasgrain {

namespace {

constexpr int most_moves = 60;
constexpr double close_to_foot = 1e-6;     // spacings that a foot may be off
constexpr double longest_move = 1.0;       // spacings
constexpr double smallest_bend = 0.02;     // of 1 + d S, in a move
constexpr double smallest_gradient = 0.3;  // |grad phi| at a foot
constexpr double rounding = 1e-13;         // by which a way may seem to have become longer

constexpr double narrow = 0.5;      // 1 + d S in a hollow less than twice as wide as the ball
constexpr int looks_around = 48;    // on the circle about x
constexpr double off_circle = 2.0;  // spacings that a wall may lie off it
constexpr double unsure_height =
    0.01;  // spacings by which a look may misjudge the height of a foot

// Curvatures of a field are those of its cells and may jump by a spacing times their derivative,
// S^2, so the distance errs by way^2 spacing S^2/2: here 1.3e-7 spacings.
constexpr double share_of_radius = 0.0005;  // that `way` is of the radius of curvature
constexpr double longest_way = 0.25;        // spacings

// A symmetric 2 x 2 matrix in the plane across a normal.
struct PlaneTensor {
  double aa, ab, bb;

  double smallest_eigenvalue() const { return 0.5 * (aa + bb) - std::hypot(0.5 * (aa - bb), ab); }
  // Angle from direction a to that of the smallest eigenvalue.
  double weakest_direction() const {
    return 0.5 * (std::atan2(2 * ab, aa - bb) + std::numbers::pi);
  }
  PlaneTensor inverse() const {
    const double determinant = aa * bb - ab * ab;
    return {bb / determinant, -ab / determinant, aa / determinant};
  }
};

// The surface at a foot, in a frame across its normal.
struct SurfaceFrame {
  Vec3 n, a, b;
  PlaneTensor curvature;  // S, 1/m

  SurfaceFrame(const Vec3& gradient, const Mat3& second_derivatives) {
    const double slope = gradient.norm();
    n = gradient / slope;
    a = n.unitOrthogonal();
    b = n.cross(a);
    const Vec3 along_a = second_derivatives * a / slope, along_b = second_derivatives * b / slope;
    curvature = {a.dot(along_a), a.dot(along_b), b.dot(along_b)};
  }
  // 1 + d S
  PlaneTensor bend(double distance) const {
    return {1 + distance * curvature.aa, distance * curvature.ab, 1 + distance * curvature.bb};
  }
  Vec3 direction(double angle) const { return std::cos(angle) * a + std::sin(angle) * b; }
  Vec3 times(const PlaneTensor& tensor, const Vec3& v) const {
    const double along_a = a.dot(v), along_b = b.dot(v);
    return (tensor.aa * along_a + tensor.ab * along_b) * a +
           (tensor.ab * along_a + tensor.bb * along_b) * b;
  }
};

NearWall curved_wall(const Vec3& away, double distance, const SurfaceFrame& frame, double spacing) {
  NearWall wall(DistanceSample{distance, away / distance});
  const PlaneTensor inverse = frame.bend(distance).inverse();
  for (int column = 0; column < 3; ++column)
    wall.curvature.col(column) =
        frame.times(frame.curvature, frame.times(inverse, Vec3::Unit(column)));
  wall.way = std::min(longest_way * spacing, share_of_radius / wall.curvature.norm());
  return wall;
}

struct Foot {
  NearWall wall;
  double least_bend;  // smallest eigenvalue of 1 + d S
  Vec3 weakest;       // its direction
};

std::optional<Foot> find_foot(const SampledDistance& field, const Vec3& x, const Vec3& start) {
  const double spacing = field.data().spacing, close = close_to_foot * spacing;
  Vec3 foot = start, last_foot = start;
  double trusted = longest_move * spacing, nearest = std::numeric_limits<double>::infinity();
  std::optional<Foot> reached;
  for (int move = 0; move < most_moves; ++move) {
    const auto here = field.curved_sample(foot);
    if (!here || here->gradient.norm() < smallest_gradient) {
      if (!reached) return std::nullopt;
      trusted *= 0.25;
      foot = 0.75 * last_foot + 0.25 * foot;
      continue;
    }
    const SurfaceFrame frame(here->gradient, here->curvature);
    const Vec3 away = x - foot;
    const double distance = away.dot(frame.n), height = here->distance / here->gradient.norm();
    const Vec3 aside = away - distance * frame.n;
    const double way = std::hypot(distance + height, aside.norm());
    const double unsure = height * height / spacing + rounding * way;
    if (way - unsure > nearest) {  // went too far
      trusted *= 0.25;
      foot = 0.75 * last_foot + 0.25 * foot;
      continue;
    }
    if (distance == 0.0) return std::nullopt;
    PlaneTensor bend = frame.bend(distance);
    reached = {NearWall({std::copysign(way, distance), away / std::copysign(way, distance)}),
               bend.smallest_eigenvalue(), frame.direction(bend.weakest_direction())};
    if (std::abs(height) < close && aside.norm() < close) {
      if (reached->least_bend < 0) return std::nullopt;  // farthest, not nearest
      reached->wall = curved_wall(away, std::copysign(away.norm(), distance), frame, spacing);
      return reached;
    }
    nearest = way + unsure;
    last_foot = foot;
    const double missing = std::max(0.0, smallest_bend - reached->least_bend);
    bend.aa += missing;
    bend.bb += missing;
    const Vec3 along = frame.times(bend.inverse(), aside);
    const Vec3 step = along * std::min(1.0, trusted / along.norm());
    const double sag = 0.5 * step.dot(frame.times(frame.curvature, step));
    foot += step - (height + sag) * frame.n;
    trusted = std::min(2 * trusted, longest_move * spacing);
  }
  if (reached) reached->wall.foot_found = false;
  return reached;
}

// Heights of the surface above the circle about x through a foot, outwards, in directions `out`; a
// place where the field tells nothing counts as one without a wall.
struct Surroundings {
  std::array<Vec3, looks_around> out;
  std::array<double, looks_around> height;  // m

  Surroundings(const SampledDistance& field, const Vec3& x, const Foot& foot) {
    for (int n = 0; n < looks_around; ++n) {
      const double turn = 2 * std::numbers::pi * n / looks_around;
      out[n] = -std::cos(turn) * foot.wall.gradient + std::sin(turn) * foot.weakest;
      const DistanceSample there = field.sample(x + foot.wall.distance * out[n]);
      const double slope = there.gradient.norm();
      height[n] = slope < smallest_gradient ? std::numeric_limits<double>::infinity()
                                            : there.distance / slope;
    }
  }
  double lowest() const { return *std::min_element(height.begin(), height.end()); }
  bool is_lower_than_beside(int n) const {
    return height[n] <= height[(n + 1) % looks_around] &&
           height[n] <= height[(n + looks_around - 1) % looks_around];
  }
};

// The nearest of the feet around the circle through a foot in a hollow.
NearWall nearest_around(const SampledDistance& field, const Vec3& x, const Foot& foot) {
  const double spacing = field.data().spacing;
  const Surroundings around(field, x, foot);
  const double highest = std::min(0.0, around.lowest()) + unsure_height * spacing;
  NearWall result = foot.wall;
  for (int n = 0; n < looks_around; ++n) {
    const double height = around.height[n];
    if (height > highest || height < -off_circle * spacing || !around.is_lower_than_beside(n))
      continue;
    const auto other = find_foot(field, x, x + (foot.wall.distance + height) * around.out[n]);
    if (other && std::abs(other->wall.distance) < result.distance) result = other->wall;
  }
  return result;
}

}  // namespace

std::optional<NearWall> wall_at_foot(const SampledDistance& field, const Vec3& x,
                                     const Vec3& start) {
  const std::optional<Foot> found = find_foot(field, x, start);
  if (!found) return std::nullopt;
  if (found->least_bend < narrow && found->wall.distance > 0)
    return nearest_around(field, x, *found);
  return found->wall;
}

}  // namespace gasgrain
