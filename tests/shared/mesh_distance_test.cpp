#include "coupling/shared/mesh_distance.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "coupling/shared/boolean_shapes.hpp"
#include "coupling/shared/known_distance.hpp"
#include "coupling/shared/primitives.hpp"
#include "coupling/shared/sampling.hpp"
#include "coupling/shared/solid_volume.hpp"
#include "tests/shared/mesh_fixture.hpp"
#include "tests/shared/shape_checks.hpp"

namespace gasgrain {
namespace {

const Vec3 lower(-0.7, -0.4, -0.5), upper(0.6, 0.5, 0.3);
const Triangles box = box_triangles(lower, upper);
const Shape exact_box =
    make_shape(Box{.center = 0.5 * (lower + upper), .half_size = 0.5 * (upper - lower)});

Shape shape_of(const Triangles& triangles) {
  return make_mesh_shape(repair_mesh(triangles), "");
}

RandomPoints around() {
  return RandomPoints(Vec3(-1.2, -1, -1), Vec3(1.2, 1, 1));
}

void expect_same_distance(const Shape& mesh, const Shape& exact) {
  RandomPoints points = around();
  for (int n = 0; n < 3000; ++n) {
    const Vec3 x = points.next();
    EXPECT_NEAR(mesh->distance(x), exact->distance(x), 1e-13) << x.transpose();
  }
}

TEST(MeshDistance, OfABoxEqualsThePrimitive) {
  const Shape mesh = shape_of(box);
  expect_same_distance(mesh, exact_box);
  expect_exact_gradient(*mesh, around());
  expect_exact_distance(*mesh, around());
}

TEST(MeshDistance, SurvivesDefects) {
  Triangles damaged = both(box, {box[3], box[8], turned(box[5])});
  damaged[0] = turned(damaged[0]);
  expect_same_distance(shape_of(damaged), exact_box);
  expect_same_distance(shape_of(turned(box)), exact_box);
  Triangles open = box;  // half of the top is missing
  open.pop_back();
  expect_same_distance(shape_of(open), exact_box);
}

TEST(MeshDistance, UnionOfOverlappingPartsIsThatOfThePrimitives) {
  const Vec3 shift(0.3, 0.2, 0.1);
  const Shape other =
      make_shape(Box{.center = 0.5 * (lower + upper) + shift, .half_size = 0.5 * (upper - lower)});
  expect_same_distance(shape_of(both(box, box_triangles(lower + shift, upper + shift))),
                       make_union({exact_box, other}));
}

TEST(MeshDistance, ACavityIsOutside) {
  const Triangles inner = box_triangles(0.5 * lower, 0.5 * upper);
  const Shape mesh = shape_of(both(box, turned(inner)));
  EXPECT_NEAR(mesh->distance(Vec3::Zero()), 0.15, 1e-13);
  EXPECT_LT(mesh->distance(0.75 * upper), 0);
}

TEST(MeshDistance, OfAFineBallConvergesToTheSphere) {
  const auto error = [](int n) {
    const Shape mesh = shape_of(ball_triangles(Vec3(0.1, 0, 0), 0.6, n));
    RandomPoints points = around();
    double largest = 0.0;
    for (int k = 0; k < 500; ++k) {
      const Vec3 x = points.next();
      largest =
          std::max(largest, std::abs(mesh->distance(x) - ((x - Vec3(0.1, 0, 0)).norm() - 0.6)));
    }
    return largest;
  };
  EXPECT_GT(std::log2(error(16) / error(32)), 1.8);
}

// The winding number of dipoles and triangles against the exact sum over triangles.
TEST(MeshDistance, SignIsRightNearAndFarFromAFineMesh) {
  const Shape mesh = shape_of(ball_triangles(Vec3::Zero(), 0.8, 64));
  RandomPoints points = around();
  for (int n = 0; n < 20000; ++n) {
    const Vec3 x = points.next();
    const double phi = x.norm() - 0.8;
    if (std::abs(phi) < 2e-3) continue;
    EXPECT_GT(mesh->distance(x) * phi, 0) << x.transpose();
  }
}

TEST(MeshDistance, ASelfIntersectingSurfaceHasTheSignOfItsUnion) {
  // a box whose upper half is turned by half a turn: crossed sides
  Triangles bow = box_triangles(Vec3(-0.5, -0.4, -0.5), Vec3(0.5, 0.4, 0.5));
  for (LooseTriangle& t : bow)
    for (Vec3& c : t)
      if (c[2] > 0) c = Vec3(-c[0], -c[1], c[2]);
  const Shape mesh = shape_of(bow);
  RandomPoints points = around();
  for (int n = 0; n < 2000; ++n) {
    const Vec3 x = points.next();
    if (x.cwiseAbs().maxCoeff() > 0.6) {
      EXPECT_GT(mesh->distance(x), 0);
    }
  }
  // two pyramids whose tips meet in the middle
  for (const double z : {-0.4, -0.2, 0.2, 0.4}) {
    EXPECT_LT(mesh->distance(Vec3(0, 0, z)), 0) << z;
    EXPECT_GT(mesh->distance(Vec3(1.2 * std::abs(z), 0, z)), 0) << z;
  }
}

TEST(MeshDistance, ASheetIsAWallAlongTheSurfaceWithItsOpenings) {
  Triangles cup = box;
  cup.resize(10);
  const Shape sheet = make_sheet_shape(cup, 0.04);
  RandomPoints points = around();
  for (int n = 0; n < 2000; ++n) {
    const Vec3 x = points.next();
    EXPECT_GE(sheet->distance(x), std::abs(exact_box->distance(x)) - 0.02 - 1e-12);
  }
  EXPECT_NEAR(sheet->distance(Vec3(lower[0], 0, 0)), -0.02, 1e-13);
  EXPECT_GT(sheet->distance(Vec3::Zero()), 0.2);
}

TEST(MeshDistance, IsTheSameWithHelpOfAKnownPlace) {
  const Triangles two_parts =
      both(box, box_triangles(lower + Vec3(0.3, 0.2, 0.1), upper + Vec3(0.3, 0.2, 0.1)));
  for (const Shape& shape :
       {shape_of(box), make_complement(shape_of(box)), shape_of(two_parts), exact_box}) {
    RandomPoints points = around();
    KnownDistance known{points.next(), 0.0};
    known.distance = shape->distance(known.place);
    for (int n = 0; n < 3000; ++n) {
      // hardly away from the known place, up to far beyond the surface
      const Vec3 x = known.place + 0.01 * (n % 100) * (points.next() - known.place);
      const double distance = shape->distance(x);
      ASSERT_EQ(distance_near(*shape, x, known), distance) << x.transpose();
      known = {x, distance};
      if (n % 100 == 99) known = {points.next(), 0.0};
    }
  }
}

TEST(MeshDistance, SampledMeshKeepsItsVolume) {
  const Shape mesh = shape_of(ball_triangles(Vec3::Zero(), 0.5, 48));
  const SampledDistance field = sample_shape(*mesh, {.lower = Vec3::Constant(-0.8),
                                                     .upper = Vec3::Constant(0.8),
                                                     .spacing = 0.02,
                                                     .band = 0.1,
                                                     .cut = false});
  EXPECT_NO_THROW(check_closed(field, "ball"));
  const double volume = repair_mesh(ball_triangles(Vec3::Zero(), 0.5, 48)).report.volume;
  const VolumeGrid grid{
      .lower = Vec3::Constant(-0.8), .spacing = 0.16, .cells = {10, 10, 10}, .halvings = 4};
  EXPECT_NEAR(solid_volume(field, grid) / volume, 1, 2e-3);
}

}  // namespace
}  // namespace gasgrain
