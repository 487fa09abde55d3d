// The walls that a ball may touch while it moves a little way, so that it need not look for them in
// every step.
//
// Space is cut into cubes of a sixteenth of the ball's radius, and those into halves, quarters and
// so on as the walls there ask for. All balls of this radius whose centre is in a cube see what is
// seen from the cube's middle m: for each wall a quadratic function
//
//   d(x) = d + n s + s H s/2,   s = x - m
//
// with the gradient of just this function, so that the elastic force has a potential; or no wall at
// all. Cubes are small enough for what the shape says of it (NearWall::way), so that d hardly jumps
// from one to the next. Where the shape cannot say, walls are looked for at x itself.
//
// What is seen depends on x, the radius and the shape alone, not on where the ball came from: a run
// that looks for walls in other steps, or begins at a restart, sees the same.
#pragma once

#include <vector>

#include "coupling/shared/near_surfaces.hpp"

namespace gasgrain {

class LocalWalls {
 public:
  // To be called first when the ball has come to x.
  void come_to(const SignedDistance& shape, const Vec3& x, double radius) {
    if (cube_of(x) != cube_ || radius != radius_ || at_place_alone_) look(shape, x, radius);
  }

  // The rest is of a ball at the x of come_to().
  int count() const { return count_; }
  DistanceSample seen_from(const Vec3& x, int n) const {
    const NearWall& wall = n == 0 ? first_ : others_[n - 1];
    const Vec3 s = x - from_, bend = wall.curvature * s;
    return {wall.distance + s.dot(wall.gradient + 0.5 * bend), wall.gradient + bend};
  }
  // Whether the place of wall n that is nearest to the ball was found (NearWall::foot_found).
  bool foot_found(int n) const { return (n == 0 ? first_ : others_[n - 1]).foot_found; }
  // How far the ball can go before it may touch a wall that is not among those, m.
  double way_left(const Vec3& x) const { return way_ - (x - from_).norm(); }

 private:
  void look(const SignedDistance& shape, const Vec3& x, double radius);
  void look_from_coarse_cube(const SignedDistance& shape, const Vec3& x, double radius);
  void look_from(const SignedDistance& shape, const Vec3& place, double radius);
  Vec3 cube_of(const Vec3& x) const { return (x * cubes_per_length_).array().floor(); }
  Vec3 middle() const { return (cube_.array() + 0.5) / cubes_per_length_; }

  double radius_ = 0.0;            // m; 0: nothing is known
  Vec3 coarse_cube_;               // number of the cube of the coarsest size, in each direction
  double cubes_per_length_ = 0.0;  // 1/m, in that cube; 0: walls must be looked for at x
  Vec3 cube_ = Vec3::Zero();       // number of the cube of that size
  bool at_place_alone_ = false;    // walls were looked for at x

  Vec3 from_ = Vec3::Zero();  // m, where walls were looked for
  double way_ = 0.0;          // m, around `from_` that no others are touched
  double exact_way_ = 0.0;    // m, around `from_` that the functions hold; 0: not even there
  int count_ = 0;
  NearWall first_;
  std::vector<NearWall> others_;  // at edges
};

}  // namespace gasgrain
