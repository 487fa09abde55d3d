#include "coupling/shared/local_walls.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "coupling/shared/near_surfaces.hpp"

namespace gasgrain {

namespace {

// By how much an interpolated field may exceed the distance where it has a kink, in radii of the
// grain: 0.05 spacings of a quarter of the radius. So far out several contacts are looked for.
constexpr double excess_at_kinks = 0.0125;

constexpr double cubes_per_radius = 16;  // of the coarsest size
constexpr double most_halvings = 128;    // of it, as a factor
const double half_diagonal = 0.5 * std::sqrt(3.0);
const Vec3 unknown_cube = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());

// Walls are looked for this much further than the ball reaches, in radii: seen from the middle of a
// cube those that are touched from anywhere in it.
constexpr double look_ahead = 0.0625;

// A smaller cube may find that its walls bend more than those seen from the coarse one did.
constexpr double tolerated = 0.5;  // of the half diagonal

}  // namespace

// Walls that a ball at `place` may touch, and how far around it that holds.
void LocalWalls::look_from(const SignedDistance& shape, const Vec3& place, double radius) {
  from_ = place;
  count_ = 0;
  others_.clear();
  exact_way_ = std::numeric_limits<double>::infinity();
  const DistanceSample nearest = shape.sample(place);
  const double clear =
      (nearest.distance - (1 + excess_at_kinks) * radius) / shape.steepest_gradient();
  way_ = look_ahead * radius;
  if (clear > way_) {
    way_ = clear;
    return;
  }
  const NearWalls walls = ball_contacts(shape, nearest, place, radius + way_);
  for (int n = 0; n < walls.count; ++n) {
    NearWall wall = walls.surface[n];
    exact_way_ = std::min(exact_way_, wall.way);
    if (wall.way == 0.0) wall.curvature = Mat3::Zero();
    if (count_++ == 0)
      first_ = wall;
    else
      others_.push_back(wall);
  }
}

// Finds out how small cubes must be around x.
void LocalWalls::look_from_coarse_cube(const SignedDistance& shape, const Vec3& x, double radius) {
  radius_ = radius;
  cubes_per_length_ = cubes_per_radius / radius;
  coarse_cube_ = cube_ = cube_of(x);
  look_from(shape, middle(), radius);
  double halvings = 1;
  while (halvings <= most_halvings && half_diagonal > halvings * cubes_per_length_ * exact_way_)
    halvings *= 2;
  at_place_alone_ = halvings > most_halvings;
  if (halvings > 1) cube_ = unknown_cube;
  cubes_per_length_ *= at_place_alone_ ? 0.0 : halvings;
}

void LocalWalls::look(const SignedDistance& shape, const Vec3& x, double radius) {
  const Vec3 coarse_cube = (x * (cubes_per_radius / radius)).array().floor();
  if (radius != radius_ || coarse_cube != coarse_cube_) look_from_coarse_cube(shape, x, radius);
  if (cubes_per_length_ > 0.0 && cube_of(x) != cube_) {
    cube_ = cube_of(x);
    look_from(shape, middle(), radius);
    at_place_alone_ = exact_way_ < tolerated * half_diagonal / cubes_per_length_;
  }
  if (at_place_alone_) look_from(shape, x, radius);
}

}  // namespace gasgrain
