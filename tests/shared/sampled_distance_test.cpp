#include "coupling/shared/sampled_distance.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "coupling/shared/boolean_shapes.hpp"
#include "coupling/shared/error.hpp"
#include "coupling/shared/primitives.hpp"
#include "coupling/shared/sampling.hpp"
#include "tests/shared/shape_checks.hpp"

namespace gasgrain {
namespace {

const Shape ball = make_shape(Sphere{Vec3(0.05, -0.02, 0.03), 0.5});
const Shape tube =
    make_shape(Cylinder{Vec3::Zero(), Vec3(0, 1, 0), 0.3, std::numeric_limits<double>::infinity()});
const Shape vessel =
    make_complement(make_shape(Box{.center = Vec3::Zero(), .half_size = Vec3(0.7, 0.6, 0.5)}));

SampledDistance sampled(const Shape& shape, double spacing, double band,
                        Interpolation interpolation = Interpolation::linear,
                        SampleStorage storage = SampleStorage::plain) {
  return sample_shape(*shape, {.lower = Vec3(-1, -1, -1),
                               .upper = Vec3(1, 1, 1),
                               .spacing = spacing,
                               .band = band,
                               .cut = true,
                               .interpolation = interpolation,
                               .storage = storage});
}

constexpr Interpolation both_kinds[] = {Interpolation::linear, Interpolation::quadratic};

// Samples are rounded to 24 bits: 3e-8 of values up to 0.6, over a spacing of 0.05.
TEST(SampledDistance, IsExactForAPlane) {
  const Shape plane = make_shape(Plane{Vec3(0.1, 0, 0), Vec3(0.36, 0.48, 0.8)});
  for (const Interpolation interpolation : both_kinds) {
    const SampledDistance field = sampled(plane, 0.05, 0.3, interpolation);
    RandomPoints points(Vec3(-1, -1, -1), Vec3(1, 1, 1));
    int in_band = 0;
    for (int n = 0; n < 2000; ++n) {
      const Vec3 x = points.next();
      if (std::abs(plane->distance(x)) > 0.3) continue;
      ++in_band;
      EXPECT_NEAR(field.distance(x), plane->distance(x), 6e-8);
      EXPECT_LT((field.sample(x).gradient - plane->sample(x).gradient).norm(), 4e-6);
    }
    EXPECT_GT(in_band, 300);
  }
}

TEST(SampledDistance, CompactSamplesAreRoundedToTheirQuantum) {
  const SampledDistance plain = sampled(ball, 0.025, 0.1, Interpolation::quadratic);
  const SampledDistance compact =
      sampled(ball, 0.025, 0.1, Interpolation::quadratic, SampleStorage::compact);
  const double quantum = compact.data().quantum;
  EXPECT_NEAR(quantum, 0.35 / 32767, 1e-12);
  EXPECT_LT(compact.memory(), 0.6 * plain.memory());
  RandomPoints points(Vec3(-1, -1, -1), Vec3(1, 1, 1));
  for (int n = 0; n < 5000; ++n) {
    const Vec3 x = points.next();
    EXPECT_NEAR(compact.distance(x), plain.distance(x), 0.51 * quantum);
  }
}

TEST(SampledDistance, QuadraticGradientIsContinuous) {
  const auto largest_jump = [](Interpolation interpolation) {
    const SampledDistance field = sampled(ball, 0.05, 0.3, interpolation);
    double jump = 0.0;
    for (int n = 0; n < 20000; ++n) {  // along a line close to the surface, far finer than cells
      const Vec3 x = Vec3(0.55, -0.4 + 0.8 * n / 20000, 0.05);
      const Vec3 y = x + Vec3(0, 0.8 / 20000, 0);
      jump = std::max(jump, (field.sample(x).gradient - field.sample(y).gradient).norm());
    }
    return jump;
  };
  EXPECT_GT(largest_jump(Interpolation::linear), 0.02);
  EXPECT_LT(largest_jump(Interpolation::quadratic), 2e-4);  // curvature 2 over 4e-5
}

TEST(SampledDistance, GradientIsTheDerivativeOfTheInterpolant) {
  for (const Interpolation interpolation : both_kinds)
    expect_exact_gradient(sampled(ball, 0.05, 0.1, interpolation),
                          RandomPoints(Vec3(-0.99, -0.99, -0.99), Vec3(0.99, 0.99, 0.99)));
}

TEST(SampledDistance, GradientIsTheDerivativeOutsideOfTheBoxToo) {
  expect_exact_gradient(sampled(ball, 0.05, 2.0), RandomPoints(Vec3(-3, -3, 1.1), Vec3(3, 3, 3)));
  expect_exact_gradient(sampled(vessel, 0.05, 2.0), RandomPoints(Vec3(-3, -3, 1.1), Vec3(3, 3, 3)));
  expect_exact_gradient(sampled(tube, 0.05, 2.0), RandomPoints(Vec3(-1, 1.1, -1), Vec3(3, 3, 3)));
}

// Largest error within half the band, for the order of the interpolation.
double largest_error(double spacing, Interpolation interpolation) {
  const SampledDistance field = sampled(ball, spacing, 0.3, interpolation);
  RandomPoints points(Vec3(-1, -1, -1), Vec3(1, 1, 1));
  double largest = 0.0;
  for (int n = 0; n < 20000; ++n) {
    const Vec3 x = points.next();
    if (std::abs(ball->distance(x)) > 0.15) continue;
    largest = std::max(largest, std::abs(field.distance(x) - ball->distance(x)));
  }
  return largest;
}

TEST(SampledDistance, LinearErrorFallsWithTheSquareOfTheSpacing) {
  const double coarse = largest_error(0.08, Interpolation::linear),
               middle = largest_error(0.04, Interpolation::linear),
               fine = largest_error(0.02, Interpolation::linear);
  EXPECT_GT(std::log2(coarse / middle), 1.8);
  EXPECT_GT(std::log2(middle / fine), 1.9);
  EXPECT_LT(fine, 0.02 * 0.02 / (4 * 0.35) * 1.5);  // h^2/8 times the two curvatures at r = 0.35
}

TEST(SampledDistance, QuadraticErrorFallsWithTheCube) {
  const double coarse = largest_error(0.08, Interpolation::quadratic),
               middle = largest_error(0.04, Interpolation::quadratic),
               fine = largest_error(0.02, Interpolation::quadratic);
  EXPECT_GT(std::log2(coarse / middle), 2.7);
  EXPECT_GT(std::log2(middle / fine), 2.7);
  EXPECT_LT(fine, 0.05 * largest_error(0.02, Interpolation::linear));
}

TEST(SampledDistance, AwayFromTheBandHasTheRightSignAndALowerBound) {
  for (const Shape& shape : {ball, tube, vessel}) {
    const SampledDistance field = sampled(shape, 0.025, 0.06);
    EXPECT_LT(static_cast<int>(field.data().stored_bricks()),
              field.data().bricks[0] * field.data().bricks[1] * field.data().bricks[2] / 2);
    RandomPoints points(Vec3(-1, -1, -1), Vec3(1, 1, 1));
    for (int n = 0; n < 20000; ++n) {
      const Vec3 x = points.next();
      const double phi = shape->distance(x);
      const DistanceSample sample = field.sample(x);
      if (std::abs(phi) <= 0.06) continue;
      EXPECT_GT(sample.distance * phi, 0.0);
      EXPECT_LE(std::abs(sample.distance), std::abs(phi) + 0.025);  // interpolated near edges
      EXPECT_GE(std::abs(sample.distance), 0.06 - 0.025);
    }
  }
}

TEST(SampledDistance, StoresEveryBrickThatTouchesTheBand) {
  for (const Interpolation interpolation : both_kinds) {
    const SampledDistance field = sampled(ball, 0.025, 0.06, interpolation);
    RandomPoints points(Vec3(-1, -1, -1), Vec3(1, 1, 1));
    for (int n = 0; n < 20000; ++n) {
      const Vec3 x = points.next();
      if (std::abs(ball->distance(x)) > field.resolved_range()) continue;
      EXPECT_GT(field.sample(x).gradient.norm(), 0.9);
    }
  }
}

TEST(SampledDistance, BoundsTheDistanceOutsideOfItsBox) {
  const SampledDistance around_ball = sampled(ball, 0.05, 2.0);
  const SampledDistance around_vessel = sampled(vessel, 0.05, 2.0);
  RandomPoints points(Vec3(-4, -4, -4), Vec3(4, 4, 4));
  for (int n = 0; n < 5000; ++n) {
    const Vec3 x = points.next();
    if (x.cwiseAbs().maxCoeff() <= 1) continue;
    EXPECT_LE(around_ball.distance(x), ball->distance(x) + 0.005);
    EXPECT_GT(around_ball.distance(x), 0.4);
    EXPECT_GE(around_vessel.distance(x), vessel->distance(x) - 0.03);
    EXPECT_LT(around_vessel.distance(x), -0.25);
  }
}

TEST(SampledDistance, IsContinuousAcrossTheSidesOfItsBox) {
  for (const Shape& shape : {ball, tube, vessel}) {
    const SampledDistance field = sampled(shape, 0.05, 2.0);
    const double side = field.upper()[1];
    for (const double x : {-0.9, -0.2, 0.1, 0.6}) {
      EXPECT_NEAR(field.distance(Vec3(x, side - 1e-12, 0.3)),
                  field.distance(Vec3(x, side + 1e-12, 0.3)), 1e-11);
    }
  }
}

TEST(SampledDistance, ContinuesACutBodyOutwards) {
  const SampledDistance field = sampled(tube, 0.05, 2.0);
  EXPECT_TRUE(field.ends_at_box());
  for (const double y : {-20.0, 1.5, 7.0}) {
    EXPECT_NEAR(field.distance(Vec3(0.5, y, 0)), 0.2, 1e-3);
    EXPECT_LT(field.distance(Vec3(0.1, y, 0.1)), 0);
  }
}

// Work of the elastic force along a closed path of many small steps, relative to the energy moved.
TEST(SampledDistance, ElasticForceDoesNoWorkOnAClosedPath) {
  const SampledDistance field = sampled(ball, 0.05, 0.3);
  const double radius = 0.2;
  const auto force = [&](const Vec3& x) {
    const DistanceSample s = field.sample(x);
    return Vec3(std::max(0.0, radius - s.distance) * s.gradient);
  };
  constexpr int steps = 200000;
  double work = 0.0, magnitude = 0.0;
  Vec3 before(0, 0, 0);
  for (int n = 0; n <= steps; ++n) {
    const double angle = 2 * M_PI * n / steps;
    const Vec3 x = Vec3(0.05 + 0.6 * std::cos(angle), -0.02 + 0.61 * std::sin(angle),
                        0.03 + 0.1 * std::sin(3 * angle));
    if (n > 0) {
      const double part = force(0.5 * (x + before)).dot(x - before);
      work += part;
      magnitude += std::abs(part);
    }
    before = x;
  }
  EXPECT_GT(magnitude, 1e-3);
  EXPECT_LT(std::abs(work), 1e-5 * magnitude);
}

// A spherical shell of twice the size has four times the area; the box eight times the volume.
TEST(SampledDistance, MemoryFollowsTheArea) {
  const auto memory = [](double radius) {
    const Shape shell = make_difference(make_shape(Sphere{Vec3::Zero(), radius}),
                                        make_shape(Sphere{Vec3::Zero(), radius - 0.005}));
    const SampledDistance field = sample_shape(*shell, {.lower = Vec3::Constant(-radius - 0.01),
                                                        .upper = Vec3::Constant(radius + 0.01),
                                                        .spacing = 1e-3,
                                                        .band = 2e-3,
                                                        .cut = false,
                                                        .interpolation = Interpolation::linear,
                                                        .storage = SampleStorage::compact});
    return static_cast<double>(field.memory());
  };
  const double small = memory(0.04), large = memory(0.08);
  EXPECT_LT(large / small, 4.6);
  // of the shell of 5 m across, by its area
  EXPECT_LT(large * std::pow(2.5 / 0.08, 2), 4.0 * 1024 * 1024 * 1024);
}

TEST(SampledDistance, BoundOfAFarBrickRemainsABound) {
  for (const float bound : {0.3f, -0.3f, 1e-6f, -1.0e5f, 0.0f}) {
    const std::int32_t entry = far_brick(bound);
    EXPECT_LT(entry, 0);
    const float kept = bound_of_far_brick(entry);
    EXPECT_LE(std::abs(kept), std::abs(bound));
    EXPECT_NEAR(kept, bound, 2.4e-7 * std::abs(bound));
  }
}

TEST(SampledDistance, RejectsDataThatDoNotFitEachOther) {
  BrickSamples good = sampled(ball, 0.1, 0.2).data();
  EXPECT_NO_THROW(SampledDistance{good});
  BrickSamples bad = good;
  bad.brick.pop_back();
  EXPECT_THROW(SampledDistance{bad}, UserError);
  bad = good;
  std::vector<float> samples = good.samples.copy();
  samples.pop_back();
  bad.samples = samples;
  EXPECT_THROW(SampledDistance{bad}, UserError);
  bad = good;
  samples = good.samples.copy();
  samples[17] = std::nan("");
  bad.samples = samples;
  EXPECT_THROW(SampledDistance{bad}, UserError);
  bad = good;
  bad.table[0] = 1 << 20;
  EXPECT_THROW(SampledDistance{bad}, UserError);
  bad = good;
  *std::max_element(bad.brick.begin(), bad.brick.end()) += 1;
  EXPECT_THROW(SampledDistance{bad}, UserError);
  for (const float bound : {0.1f, std::nanf(""), std::numeric_limits<float>::infinity()}) {
    bad = good;
    *std::min_element(bad.brick.begin(), bad.brick.end()) = far_brick(bound);
    EXPECT_THROW(SampledDistance{bad}, UserError) << bound;
  }
  bad = good;
  bad.spacing = 0;
  EXPECT_THROW(SampledDistance{bad}, UserError);
}

}  // namespace
}  // namespace gasgrain
