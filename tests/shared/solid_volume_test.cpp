#include "coupling/shared/solid_volume.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "coupling/shared/boolean_shapes.hpp"
#include "coupling/shared/primitives.hpp"
#include "coupling/shared/sampling.hpp"

namespace gasgrain {
namespace {

const VolumeGrid unit_box{Vec3(-1, -1, -1), 0.5, {4, 4, 4}, 3};

TEST(SolidVolume, IsExactForPlanesAlongTheGrid) {
  const Shape floor = make_shape(Plane{Vec3(0, 0, -0.313), Vec3(0, 0, 1)});
  EXPECT_NEAR(solid_volume(*floor, unit_box), 4 * (1 - 0.313), 1e-12);
  EXPECT_NEAR(solid_volume(*make_complement(floor), unit_box), 4 * (1 + 0.313), 1e-12);
}

TEST(SolidVolume, OfABallConvergesWithSecondOrder) {
  const Shape ball = make_shape(Sphere{Vec3(0.03, 0.05, 0.02), 0.7});
  const double exact = 4.0 / 3.0 * M_PI * std::pow(0.7, 3);
  double before = 0.0;
  for (int halvings = 3; halvings <= 5; ++halvings) {
    VolumeGrid grid = unit_box;
    grid.halvings = halvings;
    const double error = std::abs(solid_volume(*ball, grid) - exact);
    if (before > 0) {
      EXPECT_GT(std::log2(before / error), 1.8);
    }
    before = error;
  }
  EXPECT_LT(before, 1e-3 * exact);
}

TEST(SolidVolume, OfASampledBallConvergesWithSecondOrder) {
  const Shape ball = make_shape(Sphere{Vec3(0.03, 0.05, 0.02), 0.7});
  const double exact = 4.0 / 3.0 * M_PI * std::pow(0.7, 3);
  std::array<double, 3> error{};
  for (int level = 0; level < 3; ++level) {
    const double spacing = 0.125 / (1 << level);
    const SampledDistance field = sample_shape(
        *ball, {Vec3(-1, -1, -1), Vec3(1, 1, 1), spacing, default_band(spacing), false});
    // the quadrature is kept finer than the field, so that its own error does not matter
    const VolumeGrid grid{Vec3(-1, -1, -1), 0.5, {4, 4, 4}, level + 4};
    error[level] = std::abs(solid_volume(field, grid) - exact) / exact;
  }
  EXPECT_GT(std::log2(error[0] / error[1]), 1.8);
  EXPECT_GT(std::log2(error[1] / error[2]), 1.8);
}

}  // namespace
}  // namespace gasgrain
