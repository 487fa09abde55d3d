// The tools of the verification suite themselves.
#include "tests/verification/report.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "tests/verification/flow_tools.hpp"

namespace gasgrain::verification {
namespace {

TEST(Reference, share_is_around_the_value) {
  const Reference r = read_reference("-2.0", "10 %");
  EXPECT_DOUBLE_EQ(r.lower, -2.2);
  EXPECT_DOUBLE_EQ(r.upper, -1.8);
}

TEST(Reference, ranges_and_one_sided_bounds) {
  const Reference range = read_reference("", "0.295 .. 0.305");
  EXPECT_DOUBLE_EQ(range.lower, 0.295);
  EXPECT_DOUBLE_EQ(range.upper, 0.305);
  EXPECT_TRUE(std::isnan(range.value));
  EXPECT_DOUBLE_EQ(read_reference("2", ">= 1.9").lower, 1.9);
  EXPECT_TRUE(std::isinf(read_reference("2", ">= 1.9").upper));
  EXPECT_DOUBLE_EQ(read_reference("0", "<= 1e-3").upper, 1e-3);
  EXPECT_TRUE(std::isinf(read_reference("0", "<= 1e-3").lower));
  EXPECT_TRUE(std::isinf(read_reference("3", "").upper));
}

TEST(Reference, anything_else_is_refused) {
  for (const char* pass : {"about 2", "5", "% 5", "1 .. x", "> 3"}) {
    EXPECT_THROW(read_reference("1", pass), std::invalid_argument) << pass;
  }
  EXPECT_THROW(read_reference("", "5 %"), std::invalid_argument);
  EXPECT_THROW(read_reference("1.0m", "5 %"), std::invalid_argument);
}

TEST(Oscillation, of_a_sine_is_its_own) {
  std::vector<double> times, values;
  for (int n = 0; n <= 1000; ++n) {
    times.push_back(0.01 * n);
    values.push_back(0.7 + 2.0 * std::sin(2.0 * std::numbers::pi * 0.8 * times.back()));
  }
  const Oscillation o = oscillation_after(2.5, times, values);  // six periods
  EXPECT_NEAR(o.frequency, 0.8, 1e-4);
  EXPECT_NEAR(o.largest, 2.7, 1e-2);
  EXPECT_NEAR(o.smallest, -1.3, 1e-2);
  EXPECT_NEAR(o.mean, 0.7, 1e-2);
}

TEST(ObservedOrder, of_errors_that_fall_with_the_square) {
  EXPECT_DOUBLE_EQ(observed_order(0.09, 0.01, 3.0), 2.0);
  EXPECT_DOUBLE_EQ(observed_order(0.04, 0.01), 2.0);
}

}  // namespace
}  // namespace gasgrain::verification
