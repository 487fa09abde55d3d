#include "coupling/shared/boolean_shapes.hpp"

#include "coupling/shared/primitives.hpp"
#include "tests/shared/shape_checks.hpp"

namespace gasgrain {
namespace {

const Shape left = make_shape(Sphere{Vec3(-0.5, 0, 0), 1.0});
const Shape right = make_shape(Sphere{Vec3(0.5, 0, 0), 1.0});
const Shape block = make_shape(Box{.center = Vec3::Zero(), .half_size = Vec3(1, 1.2, 0.6)});
const RandomPoints everywhere(Vec3(-2, -2, -2), Vec3(2, 2, 2));

bool solid(const Shape& shape, const Vec3& x) {
  return shape->distance(x) < 0;
}

TEST(BooleanShapes, AreSolidWhereTheSetOperationIs) {
  const Shape both = make_union({left, right, block});
  const Shape common = make_intersection({left, right, block});
  const Shape cut = make_difference(block, left);
  const Shape outside = make_complement(block);
  RandomPoints points = everywhere;
  for (int n = 0; n < 5000; ++n) {
    const Vec3 x = points.next();
    EXPECT_EQ(solid(both, x), solid(left, x) || solid(right, x) || solid(block, x));
    EXPECT_EQ(solid(common, x), solid(left, x) && solid(right, x) && solid(block, x));
    EXPECT_EQ(solid(cut, x), solid(block, x) && !solid(left, x));
    EXPECT_EQ(solid(outside, x), !solid(block, x));
  }
}

TEST(BooleanShapes, GradientIsTheDerivativeOfTheDistance) {
  expect_exact_gradient(*make_union({left, right, block}), everywhere);
  expect_exact_gradient(*make_intersection({left, block}), everywhere);
  expect_exact_gradient(*make_difference(block, left), everywhere);
  expect_exact_gradient(*make_complement(block), everywhere);
}

TEST(BooleanShapes, UnionIsExactOutside) {
  // sphere of radius 1 at x = -0.5 and 0.5: from above the seam the nearest point lies on the
  // seam's sides, at the distance to either sphere
  const Shape both = make_union({left, right});
  EXPECT_DOUBLE_EQ(both->distance(Vec3(3.5, 0, 0)), 2.0);
  EXPECT_DOUBLE_EQ(both->distance(Vec3(0, 0, 2)), std::hypot(0.5, 2.0) - 1.0);
}

TEST(BooleanShapes, NeverOverestimateTheDistance) {
  // |phi| bounds how far the surface is: a step of that length in any direction keeps the sign
  const Shape cut = make_difference(block, left);
  RandomPoints points = everywhere, directions(Vec3(-1, -1, -1), Vec3(1, 1, 1));
  for (int n = 0; n < 5000; ++n) {
    const Vec3 x = points.next();
    const double phi = cut->distance(x);
    const Vec3 y = x + 0.999 * std::abs(phi) * directions.next().normalized();
    EXPECT_GT(phi * cut->distance(y), 0.0);
  }
}

TEST(BooleanShapes, ComplementTurnsTheBoxIntoAVessel) {
  const Shape vessel = make_complement(block);
  EXPECT_DOUBLE_EQ(vessel->distance(Vec3(0.9, 0, 0)), 0.1);
  EXPECT_EQ(vessel->sample(Vec3(0.9, 0, 0)).gradient, Vec3(-1, 0, 0));  // into the gas
  EXPECT_DOUBLE_EQ(vessel->distance(Vec3(1.5, 0, 0)), -0.5);
}

}  // namespace
}  // namespace gasgrain
