#include "coupling/lone_grains.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace gasgrain::coupling {
namespace {

ExchangeReport report_of(long alone, long inside) {
  ExchangeReport report;
  report.grains_alone = alone;
  report.grains_inside = inside;
  return report;
}

// The grain's force on the gas comes back as the mean of the Stokeslet's 1/(6 pi mu r) over the
// distance r of two points, each of which is spread like the kernel: a Gaussian of variance 2 s^2.
TEST(LoneGrains, lose_the_slip_that_the_stokeslet_gives) {
  const double diameter = 2e-4, width = 2.4e-4, dr = 1e-3 * width;
  double mean_inverse = 0.0;
  for (double r = 0.5 * dr; r < 20 * width; r += dr)
    mean_inverse += 4 * M_PI * r * std::exp(-r * r / (4 * width * width)) * dr;
  mean_inverse /= std::pow(4 * M_PI * width * width, 1.5);
  const double law = 3 * M_PI * diameter * mean_inverse / (6 * M_PI);
  EXPECT_NEAR(self_slowing(diameter, width), law, 1e-5 * law);
}

TEST(LoneGrains, are_warned_of_when_they_are_most_and_the_kernel_is_narrow) {
  const auto warning = warning_of_lone_grains(report_of(6, 10), 1e-3, 1.2e-3);
  ASSERT_TRUE(warning);
  EXPECT_NE(warning->find("6 of 10 grains"), std::string::npos) << *warning;
  EXPECT_NE(warning->find("24 %"), std::string::npos) << *warning;
  EXPECT_NE(warning->find("coupling.kernel_width = 0.014"), std::string::npos) << *warning;
  EXPECT_FALSE(warning_of_lone_grains(report_of(5, 10), 1e-3, 1.2e-3));
  EXPECT_FALSE(warning_of_lone_grains(report_of(0, 0), 1e-3, 1.2e-3));
  EXPECT_FALSE(warning_of_lone_grains(report_of(10, 10), 1e-3, 15e-3));
  EXPECT_FALSE(warning_of_lone_grains(report_of(10, 10), 1e-3, 0.0));
}

}  // namespace
}  // namespace gasgrain::coupling
