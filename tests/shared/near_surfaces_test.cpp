#include "coupling/shared/near_surfaces.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "coupling/shared/boolean_shapes.hpp"
#include "coupling/shared/primitives.hpp"
#include "coupling/shared/sampling.hpp"

namespace gasgrain {
namespace {

constexpr double radius = 0.2;

NearWalls contacts(const Shape& shape, const Vec3& x) {
  return ball_contacts(*shape, shape->sample(x), x, radius);
}

Shape half_space(const Vec3& normal) {
  return make_shape(Plane{Vec3::Zero(), normal.normalized()});
}

// Two walls that meet in the z axis at this angle, the ball's centre `gap` from each beyond r.
struct Wedge {
  Shape shape;
  Vec3 first, second;  // normals
  Vec3 place;          // m, at distance r less `overlap` from both

  Wedge(double degrees, double overlap) {
    const double half = 0.5 * degrees * M_PI / 180;
    first = Vec3(std::sin(half), std::cos(half), 0);
    second = Vec3(std::sin(half), -std::cos(half), 0);
    shape = make_union({half_space(first), half_space(second)});
    place = Vec3((radius - overlap) / std::sin(half), 0, 0.03);
  }
};

Shape sampled(const Shape& shape, Interpolation interpolation) {
  return std::make_shared<const SampledDistance>(
      sample_shape(*shape, {.lower = Vec3::Constant(-0.8),
                            .upper = Vec3::Constant(0.8),
                            .spacing = radius / 4,
                            .band = 0.35,
                            .cut = true,
                            .interpolation = interpolation}));
}

void expect_both_walls(const NearWalls& found, const Wedge& wedge, double overlap,
                       double tolerance) {
  ASSERT_EQ(found.count, 2);
  double to_first = 0.0, to_second = 0.0;
  for (int n = 0; n < 2; ++n) {
    EXPECT_NEAR(found.surface[n].distance, radius - overlap, tolerance);
    to_first = std::max(to_first, found.surface[n].gradient.dot(wedge.first));
    to_second = std::max(to_second, found.surface[n].gradient.dot(wedge.second));
  }
  EXPECT_NEAR(to_first, 1.0, 1e-5);
  EXPECT_NEAR(to_second, 1.0, 1e-5);
}

TEST(NearSurfaces, ABallInAWedgeTouchesBothWalls) {
  for (const double degrees : {60.0, 90.0, 120.0}) {
    const double overlap = 1e-3;
    const Wedge wedge(degrees, overlap);
    expect_both_walls(contacts(wedge.shape, wedge.place), wedge, overlap, 1e-14);
    for (const Interpolation interpolation : {Interpolation::linear, Interpolation::quadratic}) {
      SCOPED_TRACE(degrees);
      expect_both_walls(contacts(sampled(wedge.shape, interpolation), wedge.place), wedge, overlap,
                        1e-6);
    }
  }
}

// Near the edge samples mix both walls; the distance of the one that is touched must not suffer.
TEST(NearSurfaces, ABallThatTouchesOneWallNearAnEdgeFeelsThatOneAlone) {
  const Wedge wedge(90.0, 1e-3);
  for (const Interpolation interpolation : {Interpolation::linear, Interpolation::quadratic}) {
    const Shape field = sampled(wedge.shape, interpolation);
    for (double away = 0.004; away < 0.2; away += 0.004) {
      const Vec3 x = wedge.place + away * Vec3(wedge.first[1], -wedge.first[0], 0);
      const NearWalls found = contacts(field, x);
      ASSERT_EQ(found.count, 1) << away;
      EXPECT_NEAR(found.surface[0].distance, radius - 1e-3, 1e-3 * radius) << away;
    }
  }
}

// A floor and a post on it that is hardly wider than the ball: the foot on the post must be found
// from samples some way off.
TEST(NearSurfaces, ABallBesideARoundPostTouchesPostAndFloor) {
  constexpr double post_radius = 0.3, overlap = 1e-3;
  const Shape scene = make_union(
      {half_space(Vec3(0, 0, 1)),
       make_shape(Cylinder{Vec3::Zero(), Vec3(0, 0, 1), post_radius, /* half_length */ 10.0})});
  const Shape field = sampled(scene, Interpolation::quadratic);
  for (double turn = 0.0; turn < 6.0; turn += 0.37) {
    const Vec3 out(std::cos(turn), std::sin(turn), 0);
    const NearWalls found = contacts(
        field, (post_radius + radius - overlap) * out + (radius - overlap) * Vec3(0, 0, 1));
    ASSERT_EQ(found.count, 2) << turn;
    for (int n = 0; n < 2; ++n) {
      EXPECT_NEAR(found.surface[n].distance, radius - overlap, 0.05 * overlap) << turn;
      const double to_wall =
          std::max(found.surface[n].gradient.dot(out), found.surface[n].gradient[2]);
      EXPECT_NEAR(to_wall, 1.0, 1e-4) << turn;
    }
  }
}

// Where the ball touches within the rounding of a blunt edge (r/4 spacing: beyond 105 degrees) its
// distances are those of the rounded edge. The ball is never lost, and the error stays below 0.5 %
// of its radius.
TEST(NearSurfaces, ABluntEdgeErrsByLessThanHalfAPercentOfTheRadius) {
  for (double degrees = 100.0; degrees < 176.0; degrees += 5.0) {
    const Wedge wedge(degrees, 1e-3);
    const Shape field = sampled(wedge.shape, Interpolation::quadratic);
    for (const double along : {-1.0, -0.4, 0.0, 0.3, 1.0}) {
      const Vec3 x = wedge.place + Vec3(0, along * 1e-3, 0.017);
      const NearWalls found = contacts(field, x);
      ASSERT_GE(found.count, 1) << degrees;
      EXPECT_NEAR(found.surface[0].distance, wedge.shape->distance(x), 0.005 * radius) << degrees;
      if (degrees < 151.0) {
        EXPECT_EQ(found.count, 2) << degrees;
      }
    }
  }
}

TEST(NearSurfaces, NearlyParallelWallsAreOneContact) {
  const Wedge wedge(170.0, 1e-3);
  EXPECT_EQ(contacts(wedge.shape, wedge.place).count, 1);
}

TEST(NearSurfaces, CoveredPartsOfAUnionAreNotTouched) {
  // a block on a floor; the floor below the block is no surface
  const Shape scene =
      make_union({half_space(Vec3(0, 0, 1)),
                  make_shape(Box{.center = Vec3::Zero(), .half_size = Vec3(1, 1, 0.1)})});
  EXPECT_EQ(contacts(scene, Vec3(0, 0, 0.25)).count, 1);
  EXPECT_EQ(contacts(scene, Vec3(1.15, 0, 0.19)).count, 2);
}

TEST(NearSurfaces, ASmoothConcaveWallIsTouchedOnce) {
  const Shape bowl = make_complement(make_shape(Sphere{Vec3::Zero(), 0.6}));
  for (const Interpolation interpolation : {Interpolation::linear, Interpolation::quadratic}) {
    const NearWalls found = contacts(sampled(bowl, interpolation), Vec3(0.25, 0.2, 0.26));
    ASSERT_EQ(found.count, 1);
    EXPECT_NEAR(found.surface[0].distance, 0.6 - Vec3(0.25, 0.2, 0.26).norm(), 5e-3);
  }
}

}  // namespace
}  // namespace gasgrain
