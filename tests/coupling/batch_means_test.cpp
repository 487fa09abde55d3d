#include "coupling/batch_means.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace gasgrain::coupling {
namespace {

TEST(BatchMean, is_weighted_by_the_intervals) {
  const std::vector<TimedSample> samples{{1.0, 1.0, 10.0}, {4.0, 3.0, 2.0}};
  EXPECT_DOUBLE_EQ(batch_mean(samples, 0.0).value, 4.0);
}

TEST(BatchMean, takes_only_samples_after_the_start) {
  const std::vector<TimedSample> samples{{1.0, 1.0, 10.0}, {2.0, 1.0, 2.0}};
  EXPECT_DOUBLE_EQ(batch_mean(samples, 1.0).value, 2.0);
}

TEST(BatchMean, is_nan_without_samples) {
  EXPECT_TRUE(std::isnan(batch_mean({{1.0, 1.0, 10.0}}, 2.0).value));
}

TEST(BatchMean, has_no_interval_with_fewer_samples_than_batches) {
  EXPECT_FALSE(batch_mean({{1.0, 1.0, 10.0}, {2.0, 1.0, 11.0}}, 0.0).half_width.has_value());
}

TEST(BatchMean, interval_of_a_constant_is_zero) {
  std::vector<TimedSample> samples;
  for (int n = 1; n <= 40; ++n) samples.push_back({0.1 * n, 0.1, 7.0});
  EXPECT_NEAR(*batch_mean(samples, 0.0).half_width, 0.0, 1e-12);
}

// Ten samples are ten batches: the half width is that of the textbook t interval.
TEST(BatchMean, interval_of_ten_samples_is_students) {
  std::vector<TimedSample> samples;
  for (int n = 1; n <= 10; ++n) samples.push_back({double(n), 1.0, double(n)});
  const double deviation = std::sqrt(82.5 / 9);  // of 1..10
  EXPECT_NEAR(*batch_mean(samples, 0.0).half_width, 2.2622 * deviation / std::sqrt(10.0), 1e-3);
}

TEST(BatchMean, interval_holds_the_true_mean_of_noise_about_95_times_of_100) {
  std::mt19937 random(7);
  std::normal_distribution<double> noise(3.0, 1.0);
  int held = 0;
  constexpr int trials = 2000;
  for (int trial = 0; trial < trials; ++trial) {
    std::vector<TimedSample> samples;
    for (int n = 1; n <= 100; ++n) samples.push_back({double(n), 1.0, noise(random)});
    const TimeMean mean = batch_mean(samples, 0.0);
    held += std::abs(mean.value - 3.0) <= *mean.half_width;
  }
  EXPECT_NEAR(double(held) / trials, 0.95, 0.015);  // three standard deviations of the count
}

}  // namespace
}  // namespace gasgrain::coupling
