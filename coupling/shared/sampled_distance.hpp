// A signed distance sampled on a uniform grid, stored only near the surface, interpolated
// trilinearly.
//
//   phi(x) = sum over the 8 samples of x's cell of weight(x) * sample,   grad phi = its derivative
//
// The grid is cut into bricks of 8^3 cells. Bricks that come within `band` of the surface hold
// their 9^3 samples (faces shared with the neighbour are stored twice, so that a cell needs one
// brick); all others hold one value: the sign and a lower bound, >= band, of |phi| in the whole
// brick. There the gradient is zero. Trilinear interpolation is continuous, so 1/2 k (r - phi)^2 is
// a potential whose force k (r - phi) grad phi does no net work on a closed path (eq 18-20); its
// error against the distance is O(h^2 curvature), and O(h) at edges.
//
// Outside of the sampled box: no solid on its surface - the larger of the two lower bounds
// phi(c) - |x-c| and |x-c| + (smallest phi on the box), c the nearest point of the box; no gas on
// it - the same with signs reversed; both - the body is cut by the box and continues outwards with
// the value at c.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "coupling/shared/signed_distance.hpp"

namespace gasgrain {

// What a file stores. Brick (i, j, k) has index (k * bricks[1] + j) * bricks[0] + i, and so have
// the samples within a brick (9 in each direction).
struct BrickSamples {
  Vec3 lower = Vec3::Zero();       // first sample, m
  double spacing = 0.0;            // m
  double band = 0.0;               // |phi| up to here is resolved, m
  bool cut = false;                // the body may end at the sides of the sampled box
  std::array<int, 3> bricks{};     // number in each direction
  std::vector<std::int32_t> slot;  // per brick: its place in `samples`, or -1: not stored
  std::vector<double> far_value;   // per brick: value where it is not stored, m; else 0
  std::vector<double> samples;     // 729 per stored brick, m
};

class SampledDistance final : public SignedDistance {
 public:
  static constexpr int brick_cells = 8;   // per direction
  static constexpr int brick_points = 9;  // samples per direction
  static constexpr int samples_per_brick = brick_points * brick_points * brick_points;

  // Throws UserError when the sizes do not fit each other or a value is not finite.
  explicit SampledDistance(BrickSamples data);

  double distance(const Vec3& x) const override { return sample(x).distance; }
  DistanceSample sample(const Vec3& x) const override {
    const Vec3 position = (x - data_.lower) * inverse_spacing_;
    if ((position.array() >= 0.0).all() && (position.array() <= cells_.array()).all()) {
      return sample_inside(position);
    }
    return sample_outside(x);
  }
  double resolved_range() const override { return data_.band; }

  const BrickSamples& data() const { return data_; }
  Vec3 lower() const { return data_.lower; }
  Vec3 upper() const { return data_.lower + cells_ * data_.spacing; }
  std::size_t stored_bricks() const { return data_.samples.size() / samples_per_brick; }
  std::size_t memory() const;  // bytes

  // Both solid and gas lie on the surface of the sampled box.
  bool ends_at_box() const { return surroundings_ == Surroundings::both; }

 private:
  enum class Surroundings { gas, solid, both };

  DistanceSample sample_inside(const Vec3& position) const;
  DistanceSample sample_outside(const Vec3& x) const;
  void find_surroundings();

  BrickSamples data_;
  double inverse_spacing_ = 0.0;
  Vec3 cells_ = Vec3::Zero();  // number of cells in each direction
  Surroundings surroundings_ = Surroundings::gas;
  double nearest_to_box_ = 0.0;  // smallest |phi| on the surface of the box, m
};

// `position` in cells from the first sample, within the sampled box.
inline DistanceSample SampledDistance::sample_inside(const Vec3& position) const {
  std::array<int, 3> cell;
  Vec3 f;  // place within the cell, 0..1
  for (int d = 0; d < 3; ++d) {
    cell[d] = std::min(static_cast<int>(position[d]), data_.bricks[d] * brick_cells - 1);
    f[d] = position[d] - cell[d];
  }
  const std::size_t brick =
      (static_cast<std::size_t>(cell[2] / brick_cells) * data_.bricks[1] + cell[1] / brick_cells) *
          data_.bricks[0] +
      cell[0] / brick_cells;
  const std::int32_t slot = data_.slot[brick];
  if (slot < 0) return {data_.far_value[brick], Vec3::Zero()};

  constexpr int row = brick_points, layer = brick_points * brick_points;
  const double* s = data_.samples.data() + static_cast<std::size_t>(slot) * samples_per_brick +
                    (cell[2] % brick_cells) * layer + (cell[1] % brick_cells) * row +
                    cell[0] % brick_cells;
  // differences along x on the four edges, then values there, then the same in y and z
  const double x00 = s[1] - s[0], x10 = s[row + 1] - s[row];
  const double x01 = s[layer + 1] - s[layer], x11 = s[layer + row + 1] - s[layer + row];
  const double v00 = s[0] + f[0] * x00, v10 = s[row] + f[0] * x10;
  const double v01 = s[layer] + f[0] * x01, v11 = s[layer + row] + f[0] * x11;
  const double y0 = v10 - v00, y1 = v11 - v01;
  const double v0 = v00 + f[1] * y0, v1 = v01 + f[1] * y1;
  const double x0 = x00 + f[1] * (x10 - x00), x1 = x01 + f[1] * (x11 - x01);
  return {v0 + f[2] * (v1 - v0),
          Vec3(x0 + f[2] * (x1 - x0), y0 + f[2] * (y1 - y0), v1 - v0) * inverse_spacing_};
}

}  // namespace gasgrain
