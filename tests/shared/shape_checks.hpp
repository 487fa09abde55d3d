// What every signed distance must satisfy, checked at random points against independent truth.
#pragma once

#include <gtest/gtest.h>

#include <random>

#include "coupling/shared/signed_distance.hpp"

namespace gasgrain {

// Points spread evenly over a box, the same in every run.
class RandomPoints {
 public:
  RandomPoints(Vec3 lower, Vec3 upper) : lower_(lower), upper_(upper) {}
  Vec3 next() {
    Vec3 x;
    for (int d = 0; d < 3; ++d) x[d] = lower_[d] + (upper_[d] - lower_[d]) * unit_(generator_);
    return x;
  }

 private:
  Vec3 lower_, upper_;
  std::mt19937_64 generator_{20190611};
  std::uniform_real_distribution<double> unit_{0.0, 1.0};
};

inline Vec3 central_difference(const SignedDistance& shape, const Vec3& x, double step) {
  Vec3 result;
  for (int d = 0; d < 3; ++d) {
    result[d] =
        (shape.distance(x + step * Vec3::Unit(d)) - shape.distance(x - step * Vec3::Unit(d))) /
        (2 * step);
  }
  return result;
}

// True when the two one-sided differences agree: no kink of the distance near x.
inline bool is_smooth_at(const SignedDistance& shape, const Vec3& x, double step) {
  const double here = shape.distance(x);
  for (int d = 0; d < 3; ++d) {
    const double up = shape.distance(x + step * Vec3::Unit(d)) - here;
    const double down = here - shape.distance(x - step * Vec3::Unit(d));
    if (std::abs(up - down) > 1e-3 * step) return false;
  }
  return true;
}

// The gradient is the derivative of the distance; kinks may hit a small share of the points.
inline void expect_exact_gradient(const SignedDistance& shape, RandomPoints points) {
  constexpr int tried = 2000;
  constexpr double step = 1e-6;
  int smooth = 0;
  for (int n = 0; n < tried; ++n) {
    const Vec3 x = points.next();
    if (!is_smooth_at(shape, x, step)) continue;
    ++smooth;
    const DistanceSample sample = shape.sample(x);
    EXPECT_LT((sample.gradient - central_difference(shape, x, step)).norm(), 2e-6)
        << "at " << x.transpose();
    EXPECT_EQ(sample.distance, shape.distance(x));
  }
  EXPECT_GT(smooth, 0.9 * tried);
}

// Exact distances have unit gradients and lead to the surface: phi(x - phi grad phi) = 0.
inline void expect_exact_distance(const SignedDistance& shape, RandomPoints points) {
  for (int n = 0; n < 2000; ++n) {
    const Vec3 x = points.next();
    const DistanceSample sample = shape.sample(x);
    EXPECT_NEAR(sample.gradient.norm(), 1.0, 1e-12);
    const Vec3 foot = x - sample.distance * sample.gradient;
    EXPECT_NEAR(shape.distance(foot), 0.0, 1e-12) << "at " << x.transpose();
  }
}

}  // namespace gasgrain
