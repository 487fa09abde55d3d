// A signed distance sampled on a uniform grid, stored only near the surface.
//
//   phi(x) = sum over the nearest samples of weight(x) * sample,   grad phi = its derivative
//
// linear:    the 8 samples of x's cell; phi is continuous and reproduces the samples. Gradients
//            jump at the sides of cells.
// quadratic: B-spline of the 27 nearest samples; phi and grad phi are continuous. Stored are its
//            coefficients c = s - (1/8) sum of second differences of the distances s, which makes
//            it exact for quadratic functions (quasi-interpolation; de Boor, A Practical Guide to
//            Splines, ch. XII).
//
// Either is a potential, so the force k (r - phi) grad phi does no net work on a closed path
// (eq 18-20). Error against the distance: O(h^2 curvature) and O(h^3), O(h) at edges.
//
// The samples are cut into bricks of 4^3, bricks into blocks of 8^3 bricks. A brick is stored when
// one of its samples is needed within `band` of the surface; others hold a value with the right
// sign that is a lower bound, >= band, of |phi| everywhere in them, and so do whole blocks. There
// the gradient is zero. So memory follows the area of the surface.
//
// Outside of the sampled box: no solid on its surface - the larger of the two lower bounds
// phi(c) - |x-c| and |x-c| + (smallest phi on the box), c the nearest point of the box; no gas on
// it - the same with signs reversed; both - the body is cut by the box and continues outwards with
// the value at c.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "coupling/shared/near_surfaces.hpp"
#include "coupling/shared/sample_stencil.hpp"
#include "coupling/shared/shared_array.hpp"
#include "coupling/shared/signed_distance.hpp"

namespace gasgrain {

enum class Interpolation { linear, quadratic };

using Index3 = std::array<int, 3>;

// Entry of a brick that is not stored, in place of a place in the samples: minus (the top bit) the
// upper 31 bits of a bound of phi (m), which lose a rounding towards zero and remain a bound.
inline std::int32_t far_brick(float bound) {
  return static_cast<std::int32_t>(0x80000000u | (std::bit_cast<std::uint32_t>(bound) >> 1));
}
inline float bound_of_far_brick(std::int32_t entry) {
  return std::bit_cast<float>(static_cast<std::uint32_t>(entry) << 1);
}

// What a file stores. x runs fastest, in blocks, in bricks of a block, in samples of a brick.
struct BrickSamples {
  Vec3 lower = Vec3::Zero();  // lower corner of the box; one layer of samples lies outside of it, m
  double spacing = 0.0;       // m
  double band = 0.0;          // |phi| up to here is resolved, m
  bool cut = false;           // the body may end at the sides of the sampled box
  Interpolation interpolation = Interpolation::linear;
  Index3 bricks{};                  // number in each direction
  std::vector<std::int32_t> table;  // per block: which part of `brick` is its own, or -1: far block
  std::vector<float> block_value;   // per far block: sign and lower bound, m; else 0
  std::vector<std::int32_t>
      brick;                   // 512 per block with bricks: place in the samples, or far_brick()
  SharedArray<float> samples;  // 64 per stored brick, m; empty when they are compact
  SharedArray<std::int16_t> compact_samples;  // the same in units of `quantum`
  double quantum = 0.0;                       // m; 0: samples are not compact

  Index3 blocks() const;  // number in each direction
  std::size_t stored_bricks() const;
};

class SampledDistance final : public SignedDistance, public CurvedDistance {
 public:
  static constexpr int brick_points = 4;  // samples per direction and brick
  static constexpr int block_bricks = 8;  // bricks per direction and block
  static constexpr int samples_per_brick = brick_points * brick_points * brick_points;
  static constexpr int bricks_per_block = block_bricks * block_bricks * block_bricks;

  struct CurvedSample : DistanceSample {
    Mat3 curvature;  // second derivatives, 1/m
  };

  // A brick: stored at `slot`, or (slot < 0) with a bound of phi.
  struct Brick {
    std::int32_t slot;
    float far_value;  // m
  };

  // Throws UserError when the sizes do not fit each other or a value is not finite.
  explicit SampledDistance(BrickSamples data);

  double distance(const Vec3& x) const override { return sample(x).distance; }
  DistanceSample sample(const Vec3& x) const override;
  double resolved_range() const override { return data_.band; }
  double steepest_gradient() const override;
  bool has_several_contacts() const override { return true; }
  void add_near_surfaces(const Vec3& x, double reach, NearSurfaces& found) const override {
    add_without_curvature(*this, x, reach, found);
  }
  void add_near_walls(const Vec3& x, double reach, NearWalls& found) const override;

  // Of quadratic interpolation; nothing where samples are not stored.
  std::optional<CurvedSample> curved_sample(const Vec3& x) const;

  const BrickSamples& data() const { return data_; }
  Vec3 lower() const { return data_.lower; }
  Vec3 upper() const { return data_.lower + cells_ * data_.spacing; }
  std::size_t memory() const;  // bytes

  Brick brick(const Index3& brick) const;
  // A sample (or coefficient) of a stored brick, m; `point` from 0 to 3.
  double stored(std::int32_t slot, const Index3& point) const;
  // Position of a sample, m.
  Vec3 position(const Index3& brick, const Index3& point) const;

  // Both solid and gas lie on the surface of the sampled box.
  bool ends_at_box() const { return surroundings_ == Surroundings::both; }

 private:
  enum class Surroundings { gas, solid, both };

  NearWalls walls_around(const Vec3& x, const DistanceSample& nearest) const;
  std::optional<NearWall> wall_below(const Vec3& x, const Vec3& at,
                                     const DistanceSample& there) const;
  bool kink_between_cells(const Vec3& x, const DistanceSample& nearest) const;
  std::optional<NearWall> wall_below_linear(const Vec3& x, Vec3 foot) const;

  bool is_inside(const Vec3& position) const {
    return (position.array() >= 0.0).all() && (position.array() <= cells_.array()).all();
  }
  double sample_unit() const { return data_.quantum > 0 ? data_.quantum : 1.0; }
  DistanceSample sample_inside(const Vec3& position) const;
  DistanceSample sample_outside(const Vec3& x) const;
  template <int count>
  DistanceSample interpolate(const Vec3& position) const;
  template <int count>
  bool find_stencil(const Vec3& position, Index3& first, SampleStencil<count>& stencil) const;
  template <int count, class Sample>
  bool gather(const Index3& first, const SharedArray<Sample>& samples,
              SampleStencil<count>& stencil) const;
  DistanceSample far_sample(const Index3& first) const;
  void find_surroundings();

  BrickSamples data_;
  Index3 blocks_{};
  double inverse_spacing_ = 0.0;
  Vec3 cells_ = Vec3::Zero();  // number of cells in each direction
  Surroundings surroundings_ = Surroundings::gas;
  double nearest_to_box_ = 0.0;  // smallest |phi| on the surface of the box, m
};

inline SampledDistance::Brick SampledDistance::brick(const Index3& brick) const {
  const std::size_t block =
      (static_cast<std::size_t>(brick[2] / block_bricks) * blocks_[1] + brick[1] / block_bricks) *
          blocks_[0] +
      brick[0] / block_bricks;
  const std::int32_t table = data_.table[block];
  if (table < 0) return {-1, data_.block_value[block]};
  const std::size_t n =
      static_cast<std::size_t>(table) * bricks_per_block +
      ((brick[2] % block_bricks) * block_bricks + brick[1] % block_bricks) * block_bricks +
      brick[0] % block_bricks;
  const std::int32_t entry = data_.brick[n];
  return {entry, entry < 0 ? bound_of_far_brick(entry) : 0.0f};
}

}  // namespace gasgrain
