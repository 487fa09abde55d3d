// Storage checks and the continuation outside of the sampled box; see the header for the scheme.
#include "coupling/shared/sampled_distance.hpp"

#include <cmath>
#include <limits>
#include <utility>

#include "coupling/shared/error.hpp"

namespace gasgrain {

namespace {

void require(bool condition, const char* what) {
  if (!condition) {
    throw UserError(std::string("sampled distance: ") + what +
                    "; the file is damaged or was not written by gasgrain-sdf");
  }
}

bool all_finite(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
}

void check(const BrickSamples& data) {
  require(data.lower.allFinite() && std::isfinite(data.spacing) && data.spacing > 0,
          "spacing or corner is not valid");
  require(std::isfinite(data.band) && data.band > 0, "band is not positive");
  require(*std::min_element(data.bricks.begin(), data.bricks.end()) > 0,
          "number of bricks is not positive");
  const std::size_t bricks =
      static_cast<std::size_t>(data.bricks[0]) * data.bricks[1] * data.bricks[2];
  require(data.slot.size() == bricks && data.far_value.size() == bricks,
          "brick index has the wrong size");
  require(data.samples.size() % SampledDistance::samples_per_brick == 0,
          "samples are not whole bricks");
  const auto stored =
      static_cast<std::int64_t>(data.samples.size() / SampledDistance::samples_per_brick);
  for (std::size_t b = 0; b < bricks; ++b) {
    require(data.slot[b] < stored, "brick index points beyond the samples");
    require(data.slot[b] >= 0 || std::abs(data.far_value[b]) >= data.band,
            "a brick that is not stored lies within the band");
  }
  require(all_finite(data.far_value) && all_finite(data.samples), "a sample is not finite");
}

}  // namespace

SampledDistance::SampledDistance(BrickSamples data) : data_(std::move(data)) {
  check(data_);
  inverse_spacing_ = 1.0 / data_.spacing;
  for (int d = 0; d < 3; ++d) cells_[d] = data_.bricks[d] * brick_cells;
  find_surroundings();
}

std::size_t SampledDistance::memory() const {
  return data_.slot.size() * (sizeof(std::int32_t) + sizeof(double)) +
         data_.samples.size() * sizeof(double);
}

// Scans the samples on the six sides of the box.
void SampledDistance::find_surroundings() {
  double smallest = std::numeric_limits<double>::infinity(), largest = -smallest;
  for (int side = 0; side < 3; ++side) {
    const int u = (side + 1) % 3, v = (side + 2) % 3;
    for (const double end : {0.0, cells_[side]}) {
      for (int a = 0; a <= data_.bricks[u] * brick_cells; ++a) {
        for (int b = 0; b <= data_.bricks[v] * brick_cells; ++b) {
          Vec3 position;
          position[side] = end;
          position[u] = a;
          position[v] = b;
          const double value = sample_inside(position).distance;
          smallest = std::min(smallest, value);
          largest = std::max(largest, value);
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
