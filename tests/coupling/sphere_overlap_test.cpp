#include "coupling/sphere_overlap.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

namespace gasgrain::coupling {
namespace {

constexpr double whole = 4 * M_PI / 3;

TEST(SphereVolumeBeyond, known_parts) {
  EXPECT_NEAR(sphere_volume_beyond({-2, -1, -1}), whole, 1e-15);
  EXPECT_NEAR(sphere_volume_beyond({0, -2, -3}), whole / 2, 1e-15);
  EXPECT_NEAR(sphere_volume_beyond({0, -2, 0}), whole / 4, 1e-15);
  EXPECT_NEAR(sphere_volume_beyond({0, 0, 0}), whole / 8, 1e-15);
  EXPECT_NEAR(sphere_volume_beyond({-1, 0.5, -1}), M_PI * 5 / 24, 1e-15);  // cap of height 1/2
  EXPECT_EQ(sphere_volume_beyond({0.6, 0.6, 0.6}), 0.0);
  EXPECT_EQ(sphere_volume_beyond({1.0, -2, -2}), 0.0);
}

// The corner region by the midpoint rule over x and y of what stands above z = c.
double by_columns(const Vec3& corner) {
  constexpr int n = 1000;
  const double x0 = std::max(corner[0], -1.0), y0 = std::max(corner[1], -1.0);
  const double dx = (1 - x0) / n, dy = (1 - y0) / n;
  double sum = 0;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const double x = x0 + (i + 0.5) * dx, y = y0 + (j + 0.5) * dy;
      const double square = 1 - x * x - y * y;
      if (square <= 0) continue;
      const double top = std::sqrt(square);
      sum += std::max(0.0, top - std::max(corner[2], -top));
    }
  return sum * dx * dy;
}

TEST(SphereVolumeBeyond, is_that_of_an_integration) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(-1.1, 0.8);
  for (int n = 0; n < 40; ++n) {
    const Vec3 corner(place(random), place(random), place(random));
    EXPECT_NEAR(sphere_volume_beyond(corner), by_columns(corner), 2e-5) << corner.transpose();
  }
}

TEST(SphereVolumeBeyond, is_continuous_where_the_corner_leaves_the_sphere) {
  const Vec3 direction = Vec3(0.3, 0.5, 0.7).normalized();
  EXPECT_NEAR(sphere_volume_beyond((1 - 1e-7) * direction), 0.0, 1e-15);
  EXPECT_NEAR(sphere_volume_beyond({0.6, 0.8 - 1e-9, 1e-9}), 0.0, 1e-15);
  EXPECT_NEAR(sphere_volume_beyond({1e-12, -1e-12, 0}), whole / 8, 1e-11);
}

std::vector<double> shares_of(const std::vector<double>& x, const std::vector<double>& y,
                              const std::vector<double>& z) {
  std::vector<double> shares;
  sphere_shares(shares, {x, y, z});
  return shares;
}

TEST(SphereShares, add_up_to_the_sphere_and_are_never_negative) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> place(-1.0, 1.0);
  for (int n = 0; n < 200; ++n) {
    std::vector<double> planes[3];
    for (auto& p : planes) {
      p = {-1.5, place(random), place(random), place(random), 1.2};
      std::sort(p.begin(), p.end());
    }
    const auto shares = shares_of(planes[0], planes[1], planes[2]);
    EXPECT_NEAR(std::accumulate(shares.begin(), shares.end(), 0.0), 1.0, 1e-12);
    for (const double share : shares) EXPECT_GT(share, -1e-15);
  }
}

// The inscribed cube, and the share of each cell in its place.
TEST(SphereShares, know_a_box_inside_and_which_cell_is_which) {
  const double h = 1 / std::sqrt(3.0);
  const auto cube = shares_of({-h, h}, {-h, h}, {-h, h});
  EXPECT_NEAR(cube[0], 8 * h * h * h / whole, 1e-15);
  const auto shares = shares_of({-1, 0.2, 1}, {-1, -0.1, 1}, {-1, 0.3, 1});
  EXPECT_NEAR(shares[1 + 2 * (1 + 2 * 1)], sphere_volume_beyond({0.2, -0.1, 0.3}) / whole, 1e-15);
  EXPECT_NEAR(shares[0] + shares[2] + shares[4] + shares[6],
              1 - sphere_volume_beyond({0.2, -1, -1}) / whole, 1e-15);
  EXPECT_NEAR(shares[0] + shares[1], sphere_volume_beyond({-1, 0.1, -0.3}) / whole, 1e-15);
}

}  // namespace
}  // namespace gasgrain::coupling
