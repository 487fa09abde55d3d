#include "coupling/shared/primitives.hpp"

#include <cmath>
#include <limits>

#include "tests/shared/shape_checks.hpp"

namespace gasgrain {
namespace {

const RandomPoints everywhere(Vec3(-2, -2, -2), Vec3(2, 2, 2));

Mat3 turned_axes() {
  Mat3 axes;  // orthonormal, oblique to all coordinate axes
  axes << 0.8, -0.6, 0, 0.48, 0.64, -0.6, 0.36, 0.48, 0.8;
  return axes;
}

const Box box{.center = Vec3(0.1, -0.2, 0.3), .half_size = Vec3(0.5, 0.8, 1.1)};
const Cylinder finite{Vec3(0.1, 0.2, -0.1), Vec3(0.6, 0, 0.8), 0.7, 0.9};

// The distance to the nearest of many points on the box's surface, an upper bound that is tight.
double nearest_surface_point(const Vec3& x) {
  double nearest = std::numeric_limits<double>::infinity();
  constexpr int n = 60;
  for (int side = 0; side < 3; ++side) {
    const int u = (side + 1) % 3, v = (side + 2) % 3;
    for (const double end : {-1.0, 1.0}) {
      for (int i = 0; i <= n; ++i) {
        for (int j = 0; j <= n; ++j) {
          Vec3 p;
          p[side] = end * box.half_size[side];
          p[u] = (2.0 * i / n - 1) * box.half_size[u];
          p[v] = (2.0 * j / n - 1) * box.half_size[v];
          nearest = std::min(nearest, (box.center + p - x).norm());
        }
      }
    }
  }
  return nearest;
}

TEST(Primitives, PlaneIsSolidBehindItsNormal) {
  const Shape plane = make_shape(Plane{.point = Vec3(0, 0, 1), .normal = Vec3(0, 0, 1)});
  EXPECT_DOUBLE_EQ(plane->distance(Vec3(5, -3, 3)), 2.0);
  EXPECT_DOUBLE_EQ(plane->distance(Vec3(5, -3, 0.5)), -0.5);
  EXPECT_EQ(plane->sample(Vec3(1, 2, 3)).gradient, Vec3(0, 0, 1));
}

TEST(Primitives, BoxIsExactAtFacesEdgesAndCorners) {
  const Shape unit = make_shape(Box{.center = Vec3::Zero(), .half_size = Vec3::Ones()});
  EXPECT_DOUBLE_EQ(unit->distance(Vec3(3, 0, 0)), 2.0);
  EXPECT_DOUBLE_EQ(unit->distance(Vec3(4, 5, 0)), 5.0);
  EXPECT_DOUBLE_EQ(unit->distance(Vec3(-2, -2, -2)), std::sqrt(3.0));
  EXPECT_DOUBLE_EQ(unit->distance(Vec3(0.75, 0.5, 0)), -0.25);
  EXPECT_LT((unit->sample(Vec3(4, 5, 0)).gradient - Vec3(0.6, 0.8, 0)).norm(), 1e-15);
  EXPECT_EQ(unit->sample(Vec3(0.5, -0.75, 0)).gradient, Vec3(0, -1, 0));
}

TEST(Primitives, BoxDistanceIsThatToItsNearestSurfacePoint) {
  const Shape shape = make_shape(box);
  RandomPoints points = everywhere;
  for (int n = 0; n < 200; ++n) {
    const Vec3 x = points.next();
    const double nearest = nearest_surface_point(x), distance = std::abs(shape->distance(x));
    EXPECT_LE(distance, nearest + 1e-12);
    EXPECT_GE(distance, nearest - 0.03);  // spacing of the surface points
  }
}

TEST(Primitives, RotatedBoxIsTheBoxInTurnedCoordinates) {
  Box turned = box;
  turned.axes = turned_axes();
  const Shape straight = make_shape(box), rotated = make_shape(turned);
  RandomPoints points = everywhere;
  for (int n = 0; n < 200; ++n) {
    const Vec3 offset = points.next();
    EXPECT_NEAR(rotated->distance(box.center + turned.axes * offset),
                straight->distance(box.center + offset), 1e-14);
  }
}

TEST(Primitives, CylinderIsExactAtMantleEndAndRim) {
  const Shape shape = make_shape(Cylinder{Vec3::Zero(), Vec3(0, 0, 1), 1.0, 2.0});
  EXPECT_DOUBLE_EQ(shape->distance(Vec3(3, 0, 1)), 2.0);
  EXPECT_DOUBLE_EQ(shape->distance(Vec3(0.5, 0, 5)), 3.0);
  EXPECT_DOUBLE_EQ(shape->distance(Vec3(4, 0, 6)), 5.0);
  EXPECT_DOUBLE_EQ(shape->distance(Vec3(0.75, 0, 0)), -0.25);
  EXPECT_DOUBLE_EQ(shape->distance(Vec3(0.1, 0, -1.75)), -0.25);
  EXPECT_LT((shape->sample(Vec3(4, 0, -6)).gradient - Vec3(0.6, 0, -0.8)).norm(), 1e-15);
}

TEST(Primitives, ConeIsExactAtMantleEndAndTip) {
  const Shape shape = make_shape(Cone{Vec3::Zero(), Vec3(0, 0, 1), 4.0, 3.0, 0.0});  // 3-4-5
  EXPECT_NEAR(shape->distance(Vec3(0, 0, 6)), 2.0, 1e-14);
  EXPECT_NEAR(shape->distance(Vec3(0, 0, -1.5)), 1.5, 1e-14);
  EXPECT_NEAR(shape->distance(Vec3(1.5 + 0.8, 0, 2 + 0.6)), 1.0, 1e-14);
  EXPECT_NEAR(shape->distance(Vec3(0, 1.5 - 0.4, 2 - 0.3)), -0.5, 1e-14);
}

// Seen from within, each face on its own; from outside the nearest place alone.
TEST(Primitives, FacesOfABoxAndOfEndsAreFoundFromInside) {
  NearSurfaces found;
  make_shape(Box{.center = Vec3::Zero(), .half_size = Vec3(1, 1, 1)})
      ->add_near_surfaces(Vec3(0.8, -0.7, 0.1), 0.4, found);
  ASSERT_EQ(found.count, 2);
  EXPECT_NEAR(found.surface[0].distance, -0.2, 1e-15);
  EXPECT_EQ(found.surface[0].gradient, Vec3(1, 0, 0));
  EXPECT_NEAR(found.surface[1].distance, -0.3, 1e-15);
  EXPECT_EQ(found.surface[1].gradient, Vec3(0, -1, 0));
  for (const Shape& round : {make_shape(Cylinder{Vec3::Zero(), Vec3(0, 0, 1), 1.0, 2.0}),
                             make_shape(Cone{Vec3(0, 0, -2), Vec3(0, 0, 1), 4.0, 1.0, 1.0})}) {
    NearSurfaces inside, outside;
    round->add_near_surfaces(Vec3(0, 0.9, 1.7), 0.4, inside);
    EXPECT_EQ(inside.count, 2);
    round->add_near_surfaces(Vec3(0, 1.1, 2.1), 0.4, outside);
    ASSERT_EQ(outside.count, 1);
    EXPECT_NEAR(outside.surface[0].distance, std::sqrt(0.02), 1e-14);
  }
}

TEST(Primitives, CylinderWithoutEndsHasOnlyItsMantle) {
  const Shape shape = make_shape(
      Cylinder{Vec3(1, 0, 1), Vec3(0, 1, 0), 0.5, std::numeric_limits<double>::infinity()});
  EXPECT_DOUBLE_EQ(shape->distance(Vec3(1, 1e6, 3)), 1.5);
  EXPECT_DOUBLE_EQ(shape->distance(Vec3(1, -7, 1)), -0.5);
  EXPECT_NEAR(shape->sample(Vec3(1, -7, 1)).gradient.norm(), 1.0, 1e-15);
}

TEST(Primitives, SphereIsExactAndDefinedAtItsCentre) {
  const Shape shape = make_shape(Sphere{Vec3(1, 2, 3), 2.0});
  EXPECT_DOUBLE_EQ(shape->distance(Vec3(1, 2, 8)), 3.0);
  EXPECT_DOUBLE_EQ(shape->distance(Vec3(1, 2, 3)), -2.0);
  EXPECT_DOUBLE_EQ(shape->sample(Vec3(1, 2, 3)).gradient.norm(), 1.0);
}

class EveryPrimitive : public testing::TestWithParam<Shape> {};

TEST_P(EveryPrimitive, GradientIsTheDerivativeOfTheDistance) {
  expect_exact_gradient(*GetParam(), everywhere);
}

TEST_P(EveryPrimitive, LeadsToTheSurface) {
  expect_exact_distance(*GetParam(), everywhere);
}

INSTANTIATE_TEST_SUITE_P(
    Primitives, EveryPrimitive,
    testing::Values(make_shape(Plane{Vec3(0.1, 0.2, 0.3), Vec3(0.36, 0.48, 0.8)}), make_shape(box),
                    make_shape(Box{box.center, box.half_size, turned_axes()}), make_shape(finite),
                    make_shape(Cylinder{finite.center, finite.axis, finite.radius,
                                        std::numeric_limits<double>::infinity()}),
                    make_shape(Cone{Vec3(0.1, -0.2, -0.5), Vec3(0.36, 0.48, 0.8), 1.1, 0.9, 0.3}),
                    make_shape(Cone{Vec3(0.1, -0.2, -0.5), Vec3(0.36, 0.48, 0.8), 1.1, 0.0, 0.6}),
                    make_shape(Torus{Vec3(0.1, 0.2, 0.3), Vec3(0.36, 0.48, 0.8), 0.9, 0.3}),
                    make_shape(Sphere{Vec3(0.1, 0.2, 0.3), 0.9})));

}  // namespace
}  // namespace gasgrain
