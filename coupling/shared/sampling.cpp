// Sampling by blocks and bricks: first which bricks are needed, then their samples, so that memory
// is taken once and for what is stored only.
//
// phi is 1-Lipschitz: |phi(x) - phi(y)| <= |x - y|. A sample is used up to `reach` (1 or, for
// quadratic interpolation, 3/2 spacings) away from it in each direction. So a group of samples
// whose centre has |phi| > band + R, with R the half diagonal of the group enlarged by the reach,
// is not needed, and |phi| - R bounds phi wherever a sample of it would be used.
#include "coupling/shared/sampling.hpp"

#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

#include "coupling/shared/error.hpp"
#include "coupling/shared/known_distance.hpp"
#include "coupling/shared/parallel_for.hpp"
#include "coupling/shared/text.hpp"

namespace gasgrain {

namespace {

constexpr int points = SampledDistance::brick_points;
constexpr int bricks_per_side = SampledDistance::block_bricks;
constexpr double sharpest_bend = 0.3;    // spacings; of a radius of three spacings
constexpr double most_blocks = 5e7;      // 400 MB of index
constexpr double most_bricks = 2e9;      // they are numbered by 32 bits
constexpr double compact_margin = 10.0;  // spacings beyond the band that samples may lie

Index3 index_of(std::size_t n, const Index3& size) {
  const std::size_t row = size[0], layer = row * size[1];
  return {static_cast<int>(n % row), static_cast<int>(n % layer / row),
          static_cast<int>(n / layer)};
}

constexpr Index3 cube(int n) {
  return {n, n, n};
}

std::size_t count_of(const Index3& size) {
  return static_cast<std::size_t>(size[0]) * size[1] * size[2];
}

// Calls work(n) for n < count, and tells the progress from a share `from` to a share `to`.
template <class Work>
void for_each_in_parallel(std::size_t count, const SamplingEffort& effort, double from, double to,
                          const Work& work) {
  parallel_for(count, effort.threads, work, [&](std::size_t done) {
    if (effort.progress) effort.progress(from + (to - from) * static_cast<double>(done) / count);
  });
}

class Sampler {
 public:
  Sampler(const SignedDistance& shape, const SamplingBox& box, const SamplingEffort& effort)
      : shape_(shape), box_(box), effort_(effort) {}

  BrickSamples run() {
    prepare();
    choose_blocks();
    choose_bricks();
    fill();
    return std::move(data_);
  }

 private:
  void prepare() {
    data_.lower = box_.lower;
    data_.spacing = box_.spacing;
    data_.band = box_.band;
    data_.cut = box_.cut;
    data_.interpolation = box_.interpolation;
    const Vec3 cells = ((box_.upper - box_.lower) / box_.spacing).array() - 1e-9;
    for (int d = 0; d < 3; ++d)
      data_.bricks[d] = static_cast<int>(std::ceil((std::max(cells[d], 1.0) + 3.0) / points));
    const std::size_t blocks = count_of(data_.blocks());
    data_.table.assign(blocks, -1);
    data_.block_value.assign(blocks, 0.0f);
    if (box_.storage == SampleStorage::compact)
      data_.quantum =
          (box_.band + compact_margin * box_.spacing) / std::numeric_limits<std::int16_t>::max();
  }

  // Position of sample `n` (counted over all bricks), m; fractions are in between.
  Vec3 position(const Vec3& n) const { return data_.lower + data_.spacing * (n - Vec3::Ones()); }

  // Bound of |phi| where samples of a group are used, with its sign; 0 when they are needed.
  float far_value(const Index3& first, int count) const {
    const Vec3 centre = Vec3(first[0], first[1], first[2]) + Vec3::Constant(0.5 * (count - 1));
    const double reach = data_.interpolation == Interpolation::linear ? 1.0 : 1.5;
    const double radius = std::sqrt(3.0) * (0.5 * (count - 1) + reach) * data_.spacing;
    const double phi = shape_.distance(position(centre));
    const double bound = std::abs(phi) - radius;
    if (bound < data_.band) return 0.0f;
    const float value = std::nextafter(static_cast<float>(bound), 0.0f);  // not above the bound
    return std::copysign(value, static_cast<float>(phi));
  }

  void choose_blocks() {
    const Index3 blocks = data_.blocks();
    for_each_in_parallel(data_.table.size(), effort_, 0.0, 0.05, [&](std::size_t b) {
      constexpr int size = bricks_per_side * points;
      const Index3 block = index_of(b, blocks);
      data_.block_value[b] = far_value({block[0] * size, block[1] * size, block[2] * size}, size);
    });
    for (std::size_t b = 0; b < data_.table.size(); ++b) {
      if (data_.block_value[b] != 0.0f) continue;
      data_.table[b] = static_cast<std::int32_t>(divided_.size());
      divided_.push_back(b);
    }
  }

  // The brick of that place in `brick`.
  Index3 brick_at(std::size_t n) const {
    const Index3 block = index_of(divided_[n / SampledDistance::bricks_per_block], data_.blocks());
    Index3 brick = index_of(n % SampledDistance::bricks_per_block, cube(bricks_per_side));
    for (int d = 0; d < 3; ++d) brick[d] += block[d] * bricks_per_side;
    return brick;
  }

  void choose_bricks() {
    constexpr std::size_t size = SampledDistance::bricks_per_block;
    data_.brick.resize(divided_.size() * size);
    for_each_in_parallel(divided_.size(), effort_, 0.05, 0.15, [&](std::size_t t) {
      for (std::size_t n = t * size; n < (t + 1) * size; ++n) {
        const Index3 brick = brick_at(n);
        data_.brick[n] =
            far_brick(far_value({brick[0] * points, brick[1] * points, brick[2] * points}, points));
      }
    });
    std::size_t stored = 0;
    for (std::size_t n = 0; n < data_.brick.size(); ++n) {
      if (bound_of_far_brick(data_.brick[n]) != 0.0f) continue;
      const Index3 brick = brick_at(n);
      const bool exists =
          brick[0] < data_.bricks[0] && brick[1] < data_.bricks[1] && brick[2] < data_.bricks[2];
      if (exists)
        data_.brick[n] = static_cast<std::int32_t>(stored++);
      else
        data_.brick[n] = far_brick(static_cast<float>(2 * data_.band));  // never asked for
    }
    if (static_cast<double>(stored) > most_bricks)
      throw UserError("sampling needs " + std::to_string(stored) +
                      " bricks; choose a larger spacing or a narrower band");
    const std::size_t samples = stored * SampledDistance::samples_per_brick;
    if (data_.quantum > 0)
      compact_samples_.resize(samples);
    else
      samples_.resize(samples);
  }

  void fill() {
    constexpr std::size_t size = SampledDistance::bricks_per_block;
    for_each_in_parallel(divided_.size(), effort_, 0.15, 1.0, [&](std::size_t t) {
      for (std::size_t n = t * size; n < (t + 1) * size; ++n)
        if (data_.brick[n] >= 0) fill_brick(brick_at(n), data_.brick[n]);
    });
    data_.samples = std::move(samples_);
    data_.compact_samples = std::move(compact_samples_);
  }

  void fill_brick(const Index3& brick, std::int32_t slot) {
    double values[SampledDistance::samples_per_brick];
    if (data_.interpolation == Interpolation::linear)
      sample_distances(brick, values);
    else
      sample_coefficients(brick, values);
    const std::size_t begin = static_cast<std::size_t>(slot) * SampledDistance::samples_per_brick;
    for (int n = 0; n < SampledDistance::samples_per_brick; ++n) {
      if (data_.quantum > 0)
        compact_samples_[begin + n] =
            static_cast<std::int16_t>(std::lround(values[n] / data_.quantum));
      else
        samples_[begin + n] = static_cast<float>(values[n]);
    }
  }

  // `last`: the sample before, where it is taken over from.
  double distance_at(const Index3& brick, const Vec3& point, KnownDistance& last) const {
    const Vec3 place = position(Vec3(brick[0], brick[1], brick[2]) * points + point);
    last = {place, distance_near(shape_, place, last)};
    return last.distance;
  }

  void sample_distances(const Index3& brick, double* values) const {
    KnownDistance last{Vec3::Zero(), 0.0};
    for (int k = 0; k < points; ++k)
      for (int j = 0; j < points; ++j)
        for (int i = 0; i < points; ++i) *values++ = distance_at(brick, Vec3(i, j, k), last);
  }

  // s - (1/8) (sum of the second differences), each left out at kinks, where it would overshoot.
  void sample_coefficients(const Index3& brick, double* values) const {
    constexpr int wide = points + 2;
    double s[wide][wide][wide];
    KnownDistance last{Vec3::Zero(), 0.0};
    const auto outside = [](int n) { return n == 0 || n == wide - 1; };
    for (int k = 0; k < wide; ++k)
      for (int j = 0; j < wide; ++j)
        for (int i = 0; i < wide; ++i)
          if (outside(i) + outside(j) + outside(k) < 2)  // no edges
            s[k][j][i] = distance_at(brick, Vec3(i - 1, j - 1, k - 1), last);
    for (int k = 1; k <= points; ++k)
      for (int j = 1; j <= points; ++j)
        for (int i = 1; i <= points; ++i)
          *values++ = s[k][j][i] - 0.125 * (bend(s[k][j][i - 1], s[k][j][i], s[k][j][i + 1]) +
                                            bend(s[k][j - 1][i], s[k][j][i], s[k][j + 1][i]) +
                                            bend(s[k - 1][j][i], s[k][j][i], s[k + 1][j][i]));
  }

  // Second difference, or 0 for a radius of curvature that the spacing does not resolve.
  double bend(double before, double here, double after) const {
    const double difference = before - 2 * here + after;
    return std::abs(difference) < sharpest_bend * data_.spacing ? difference : 0.0;
  }

  const SignedDistance& shape_;
  const SamplingBox& box_;
  const SamplingEffort& effort_;
  BrickSamples data_;
  std::vector<float> samples_;  // as in data_, until they are complete
  std::vector<std::int16_t> compact_samples_;
  std::vector<std::size_t> divided_;  // blocks with bricks
};

void check_box(const SignedDistance& shape, const SamplingBox& box) {
  const Vec3 size = box.upper - box.lower;
  if (!(size.minCoeff() > 0)) {
    throw UserError("sampling box from " + text(box.lower) + " to " + text(box.upper) +
                    " is empty; every upper coordinate must exceed the lower one");
  }
  std::ostringstream message;
  const double blocks = (size / (bricks_per_side * points * box.spacing)).array().ceil().prod();
  if (blocks > most_blocks) {
    message << "sampling box of " << text(size) << " m needs " << blocks
            << " blocks of 32^3 samples at a spacing of " << box.spacing << " m, more than "
            << most_blocks << "; choose a larger spacing";
    throw UserError(message.str());
  }
  // coefficients near the band need distances beyond it
  const double needed =
      box.band + (box.interpolation == Interpolation::quadratic ? 4.0 * box.spacing : 0.0);
  if (needed > shape.resolved_range()) {
    message << "the band is " << box.band << " m, but the file that the body is made of resolves "
            << shape.resolved_range() << " m only; give a narrower band"
            << (needed > box.band ? ": quadratic interpolation needs four spacings more" : "");
    throw UserError(message.str());
  }
}

}  // namespace

SampledDistance sample_shape(const SignedDistance& shape, const SamplingBox& box,
                             const SamplingEffort& effort) {
  GASGRAIN_ASSERT(box.spacing > 0 && box.band > 0 && effort.threads > 0);
  check_box(shape, box);
  return SampledDistance(Sampler(shape, box, effort).run());
}

}  // namespace gasgrain
