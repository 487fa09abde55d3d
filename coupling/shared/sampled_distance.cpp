// Storage checks, interpolation, and the continuation outside of the sampled box.
//
// Interpolation gathers the samples first, from one brick (which is frequent) or from up to eight,
// and then sums them direction by direction, value and derivatives together.
#include "coupling/shared/sampled_distance.hpp"

#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "coupling/shared/error.hpp"

namespace gasgrain {

namespace {

constexpr int brick_row = SampledDistance::brick_points;
constexpr int brick_layer = brick_row * brick_row;

void require(bool condition, const char* what) {
  if (!condition) {
    throw UserError(std::string("sampled distance: ") + what +
                    "; the file is damaged or was not written by gasgrain-sdf");
  }
}

bool all_finite(std::span<const float> values) {
  return std::all_of(values.begin(), values.end(), [](float v) { return std::isfinite(v); });
}

// `index` points to one of `count` parts, or is -1 and `bound` holds beyond the band.
bool is_consistent(std::int32_t index, std::size_t count, float bound, double band) {
  constexpr double rounding = 1e-6;
  if (index >= 0) return static_cast<std::size_t>(index) < count;
  return std::isfinite(bound) && std::abs(bound) >= (1 - rounding) * band;
}

void check(const BrickSamples& data) {
  require(data.lower.allFinite() && std::isfinite(data.spacing) && data.spacing > 0,
          "spacing or corner is not valid");
  require(std::isfinite(data.band) && data.band > 0, "band is not positive");
  require(*std::min_element(data.bricks.begin(), data.bricks.end()) > 0,
          "number of bricks is not positive");
  const Index3 n = data.blocks();
  const std::size_t blocks = static_cast<std::size_t>(n[0]) * n[1] * n[2];
  require(data.table.size() == blocks && data.block_value.size() == blocks,
          "block index has the wrong size");
  require(data.brick.size() % SampledDistance::bricks_per_block == 0,
          "brick index has the wrong size");
  require(
      (data.samples.size() + data.compact_samples.size()) % SampledDistance::samples_per_brick ==
              0 &&
          (data.samples.empty() || data.compact_samples.empty()),
      "samples are not whole bricks");
  require(std::isfinite(data.quantum) && (data.quantum > 0 || data.compact_samples.empty()),
          "quantum of the samples is not valid");
  const std::size_t tables = data.brick.size() / SampledDistance::bricks_per_block;
  for (std::size_t b = 0; b < blocks; ++b)
    require(is_consistent(data.table[b], tables, data.block_value[b], data.band),
            "block index points beyond the bricks, or a far block lies within the band");
  for (const std::int32_t entry : data.brick)
    require(is_consistent(entry, data.stored_bricks(), bound_of_far_brick(entry), data.band),
            "brick index points beyond the samples, or a far brick lies within the band");
  require(all_finite(data.block_value) && all_finite(data.samples), "a sample is not finite");
}

}  // namespace

Index3 BrickSamples::blocks() const {
  Index3 result;
  for (int d = 0; d < 3; ++d)
    result[d] = (bricks[d] + SampledDistance::block_bricks - 1) / SampledDistance::block_bricks;
  return result;
}

std::size_t BrickSamples::stored_bricks() const {
  return (samples.size() + compact_samples.size()) / SampledDistance::samples_per_brick;
}

SampledDistance::SampledDistance(BrickSamples data) : data_(std::move(data)) {
  check(data_);
  blocks_ = data_.blocks();
  inverse_spacing_ = 1.0 / data_.spacing;
  for (int d = 0; d < 3; ++d) cells_[d] = data_.bricks[d] * brick_points - 3;
  find_surroundings();
}

// Distances of neighbouring samples differ by a spacing at most; coefficients at kinks by more.
double SampledDistance::steepest_gradient() const {
  constexpr double largest_difference = 1.75;
  return std::sqrt(3.0) * (data_.interpolation == Interpolation::linear ? 1.0 : largest_difference);
}

std::size_t SampledDistance::memory() const {
  return data_.table.size() * (sizeof(std::int32_t) + sizeof(float)) +
         data_.brick.size() * sizeof(std::int32_t) + data_.samples.size() * sizeof(float) +
         data_.compact_samples.size() * sizeof(std::int16_t);
}

double SampledDistance::stored(std::int32_t slot, const Index3& point) const {
  const std::size_t n = static_cast<std::size_t>(slot) * samples_per_brick +
                        point[2] * brick_layer + point[1] * brick_row + point[0];
  return data_.quantum > 0 ? data_.quantum * data_.compact_samples[n]
                           : static_cast<double>(data_.samples[n]);
}

Vec3 SampledDistance::position(const Index3& brick, const Index3& point) const {
  Vec3 steps;
  for (int d = 0; d < 3; ++d) steps[d] = brick[d] * brick_points + point[d] - 1;
  return data_.lower + data_.spacing * steps;
}

DistanceSample SampledDistance::sample(const Vec3& x) const {
  const Vec3 position = (x - data_.lower) * inverse_spacing_;
  if (is_inside(position)) return sample_inside(position);
  return sample_outside(x);
}

// `position` in cells from the corner of the box, within the box.
DistanceSample SampledDistance::sample_inside(const Vec3& position) const {
  return data_.interpolation == Interpolation::linear ? interpolate<2>(position)
                                                      : interpolate<3>(position);
}

// Copies count^3 samples beginning with sample `first`; false when one of them is not stored.
template <int count, class Sample>
bool SampledDistance::gather(const Index3& first, const SharedArray<Sample>& samples,
                             SampleStencil<count>& stencil) const {
  const Index3 home{first[0] / brick_points, first[1] / brick_points, first[2] / brick_points};
  Index3 at;          // within the first brick
  Index3 in_first{};  // how many samples of a row lie in it
  for (int d = 0; d < 3; ++d) {
    at[d] = first[d] % brick_points;
    in_first[d] = std::min(count, brick_points - at[d]);
  }
  if (in_first == Index3{count, count, count}) {
    const std::int32_t slot = brick(home).slot;
    if (slot < 0) return false;
    const Sample* own = samples.data() + static_cast<std::size_t>(slot) * samples_per_brick +
                        at[2] * brick_layer + at[1] * brick_row + at[0];
    for (int k = 0; k < count; ++k)
      for (int j = 0; j < count; ++j) {
        const Sample* row = own + k * brick_layer + j * brick_row;
        if constexpr (count == 2)
          stencil.rows[k][j] << row[0], row[1], 0, 0;
        else
          stencil.rows[k][j] << row[0], row[1], row[2], 0;
      }
    return true;
  }
  for (auto& layer : stencil.rows) layer.fill(Eigen::Array4d::Zero());
  for (int part = 0; part < 8; ++part) {  // from up to two bricks in each direction
    const Index3 next{part & 1, part >> 1 & 1, part >> 2};
    Index3 begin, end, shift;  // within the stencil; from there into the brick
    bool any = true;
    for (int d = 0; d < 3; ++d) {
      begin[d] = next[d] ? in_first[d] : 0;
      end[d] = next[d] ? count : in_first[d];
      shift[d] = next[d] ? -in_first[d] : at[d];
      any = any && begin[d] < end[d];
    }
    if (!any) continue;
    const std::int32_t slot = brick({home[0] + next[0], home[1] + next[1], home[2] + next[2]}).slot;
    if (slot < 0) return false;
    const Sample* own = samples.data() + static_cast<std::size_t>(slot) * samples_per_brick;
    for (int k = begin[2]; k < end[2]; ++k)
      for (int j = begin[1]; j < end[1]; ++j)
        for (int i = begin[0]; i < end[0]; ++i)
          stencil.rows[k][j][i] =
              own[(k + shift[2]) * brick_layer + (j + shift[1]) * brick_row + i + shift[0]];
  }
  return true;
}

// A bound where not all of the samples from `first` on are stored.
DistanceSample SampledDistance::far_sample(const Index3& first) const {
  const Brick home =
      brick({first[0] / brick_points, first[1] / brick_points, first[2] / brick_points});
  if (home.slot < 0) return {home.far_value, Vec3::Zero()};
  const double own = stored(
      home.slot, {first[0] % brick_points, first[1] % brick_points, first[2] % brick_points});
  return {std::copysign(data_.band, own), Vec3::Zero()};
}

// Weights and samples around `position`; false when one of them is not stored. Samples are in units
// of sample_unit().
template <int count>
bool SampledDistance::find_stencil(const Vec3& position, Index3& first,
                                   SampleStencil<count>& stencil) const {
  for (int d = 0; d < 3; ++d) {
    if constexpr (count == 2) {
      const int cell = std::min(static_cast<int>(position[d]), static_cast<int>(cells_[d]) - 1);
      first[d] = cell + 1;
      stencil.along[d] = row_weights<count>(position[d] - cell);
    } else {
      first[d] = static_cast<int>(position[d] + 0.5);
      stencil.along[d] = row_weights<count>(position[d] - first[d]);
    }
  }
  return data_.quantum > 0 ? gather<count>(first, data_.compact_samples, stencil)
                           : gather<count>(first, data_.samples, stencil);
}

template <int count>
DistanceSample SampledDistance::interpolate(const Vec3& position) const {
  Index3 first;
  SampleStencil<count> stencil;
  if (!find_stencil<count>(position, first, stencil)) return far_sample(first);
  const StencilSum sum = stencil.sum();
  return {sample_unit() * sum.value, sample_unit() * inverse_spacing_ * sum.gradient};
}

std::optional<SampledDistance::CurvedSample> SampledDistance::curved_sample(const Vec3& x) const {
  const Vec3 position = (x - data_.lower) * inverse_spacing_;
  Index3 first;
  SampleStencil<3> stencil;
  if (!is_inside(position) || !find_stencil<3>(position, first, stencil)) return std::nullopt;
  const StencilSum sum = stencil.sum();
  const double unit = sample_unit(), slope_unit = unit * inverse_spacing_;
  return CurvedSample{{unit * sum.value, slope_unit * sum.gradient},
                      slope_unit * inverse_spacing_ * stencil.curvature()};
}

// Looks at the six sides of the box: at the bounds of far bricks, else at the samples' places.
void SampledDistance::find_surroundings() {
  double smallest = std::numeric_limits<double>::infinity(), largest = -smallest;
  const auto note = [&](double value) {
    smallest = std::min(smallest, value);
    largest = std::max(largest, value);
  };
  const auto last = [&](int d) { return static_cast<int>(cells_[d]); };
  for (int side = 0; side < 3; ++side) {
    const int u = (side + 1) % 3, v = (side + 2) % 3;
    for (const int end : {0, last(side)}) {
      Index3 home;
      home[side] = (end + 1) / brick_points;
      for (home[v] = 0; home[v] < data_.bricks[v]; ++home[v]) {
        for (home[u] = 0; home[u] < data_.bricks[u]; ++home[u]) {
          const Brick own = brick(home);
          if (own.slot < 0) {
            note(own.far_value);
            continue;
          }
          for (int n = 0; n < brick_layer; ++n) {
            Vec3 place;
            place[side] = end;
            place[u] = home[u] * brick_points + n % brick_row - 1;
            place[v] = home[v] * brick_points + n / brick_row - 1;
            if (place[u] >= 0 && place[v] >= 0 && place[u] <= last(u) && place[v] <= last(v))
              note(sample_inside(place).distance);
          }
        }
      }
    }
  }
  surroundings_ = smallest > 0  ? Surroundings::gas
                  : largest < 0 ? Surroundings::solid
                                : Surroundings::both;
  nearest_to_box_ = surroundings_ == Surroundings::gas ? smallest : -largest;
}

DistanceSample SampledDistance::sample_outside(const Vec3& x) const {
  GASGRAIN_ASSERT(x.allFinite());
  const Vec3 position = (x - data_.lower) * inverse_spacing_;
  const Vec3 clamped = position.cwiseMax(0.0).cwiseMin(cells_);
  const Vec3 offset = (position - clamped) * data_.spacing;
  DistanceSample at_box = sample_inside(clamped);
  // the value at the clamped point does not change along clamped directions
  for (int d = 0; d < 3; ++d) {
    if (clamped[d] != position[d]) at_box.gradient[d] = 0.0;
  }
  const double away = offset.norm();
  if (surroundings_ == Surroundings::both || away == 0.0) return at_box;

  const double sign = surroundings_ == Surroundings::gas ? 1.0 : -1.0;
  const Vec3 outward = offset / away;
  const double by_value = sign * at_box.distance - away;
  const double by_box = nearest_to_box_ + away;
  if (by_value > by_box) return {sign * by_value, at_box.gradient - sign * outward};
  return {sign * by_box, sign * outward};
}

}  // namespace gasgrain
