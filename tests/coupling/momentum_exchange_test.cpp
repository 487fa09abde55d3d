#include "coupling/momentum_exchange.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace gasgrain::coupling {
namespace {

GrainRecord grain_of_ratio(double l) {
  const double d0 = 1e-4, volume = l * l * l * M_PI / 6 * d0 * d0 * d0;
  return {.position = Vec3::Zero(),
          .velocity = Vec3(0.1, 0, 0),
          .volume = volume,
          .mass = 2500 * volume,
          .original_diameter = d0};
}

TEST(ExchangeCoefficient, is_l_cubed_times_that_of_the_original) {
  const SurroundingGas gas{.void_fraction = 0.45, .velocity = Vec3(0, 0, 0.3)};
  const double original = exchange_coefficient(grain_of_ratio(1), gas, {});
  EXPECT_NEAR(exchange_coefficient(grain_of_ratio(10), gas, {}) / original, 1000.0, 1e-9);
}

// Stokes: 3 pi mu d per particle.
TEST(ExchangeCoefficient, is_stokes_drag_of_a_single_grain_without_slip) {
  const SurroundingGas gas{.void_fraction = 1.0, .velocity = Vec3(0.1, 0, 0)};
  EXPECT_NEAR(exchange_coefficient(grain_of_ratio(1), gas, {}), 3 * M_PI * 1.8e-5 * 1e-4, 1e-20);
}

TEST(ExchangeCoefficient, sees_a_limited_void_fraction) {
  DragOptions options;
  options.smallest_void_fraction = 0.3;
  const SurroundingGas dense{.void_fraction = 0.1, .velocity = Vec3::Zero()};
  const SurroundingGas limit{.void_fraction = 0.3, .velocity = Vec3::Zero()};
  EXPECT_TRUE(void_fraction_is_limited(dense, options));
  EXPECT_FALSE(void_fraction_is_limited(limit, options));
  EXPECT_EQ(exchange_coefficient(grain_of_ratio(1), dense, options),
            exchange_coefficient(grain_of_ratio(1), limit, options));
}

// 2 eps^2 (1 - eps) rho_s / beta with beta from Ergun by hand.
TEST(StableExchangeInterval, is_that_of_the_design) {
  const double eps = 0.45, slip = 0.0, d = 1e-4, mu = 1.8e-5;
  const SurroundingGas gas{.void_fraction = eps, .velocity = Vec3(0.1, 0, slip)};
  const GrainRecord grain = grain_of_ratio(5);
  const double beta = 150 * (1 - eps) * (1 - eps) * mu / (eps * d * d);
  EXPECT_NEAR(stable_exchange_interval(grain, eps, exchange_coefficient(grain, gas, {})),
              2 * eps * eps * (1 - eps) * 2500 / beta, 1e-12);
}

}  // namespace
}  // namespace gasgrain::coupling
