#include "coupling/shared/sampling.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "coupling/shared/boolean_shapes.hpp"
#include "coupling/shared/error.hpp"
#include "coupling/shared/primitives.hpp"

namespace gasgrain {
namespace {

const Shape ball = make_shape(Sphere{Vec3::Zero(), 0.5});

SampledDistance sampled(const Shape& shape, bool cut = false) {
  return sample_shape(*shape, {.lower = Vec3(-1, -1, -1),
                               .upper = Vec3(1, 1, 1),
                               .spacing = 0.05,
                               .band = 0.2,
                               .cut = cut});
}

std::string complaint(const SampledDistance& field) {
  try {
    check_closed(field, "body 'b'");
  } catch (const UserError& error) {
    return error.what();
  }
  return "";
}

// The samples of `field` passed through `change(x, phi)`.
template <class Change>
SampledDistance changed(const SampledDistance& field, const Change& change) {
  BrickSamples data = field.data();
  std::vector<float> samples = data.samples.copy();
  constexpr int n = SampledDistance::brick_points;
  for (int k = 0; k < data.bricks[2]; ++k) {
    for (int j = 0; j < data.bricks[1]; ++j) {
      for (int i = 0; i < data.bricks[0]; ++i) {
        const std::int32_t slot = field.brick({i, j, k}).slot;
        if (slot < 0) continue;
        for (int s = 0; s < SampledDistance::samples_per_brick; ++s) {
          float& phi = samples[slot * SampledDistance::samples_per_brick + s];
          phi = static_cast<float>(
              change(field.position({i, j, k}, {s % n, s / n % n, s / n / n}), phi));
        }
      }
    }
  }
  data.samples = samples;
  return SampledDistance(data);
}

TEST(Sampling, AcceptsClosedBodies) {
  EXPECT_EQ(complaint(sampled(ball)), "");
  EXPECT_EQ(complaint(sampled(make_complement(ball))), "");
  const Shape box = make_shape(Box{.center = Vec3::Zero(), .half_size = Vec3(0.7, 0.5, 0.4)});
  EXPECT_EQ(complaint(sampled(make_difference(box, ball))), "");
}

TEST(Sampling, AcceptsKinksOfTheQuadraticInterpolation) {
  const Shape box = make_shape(Box{.center = Vec3::Zero(), .half_size = Vec3(0.7, 0.5, 0.4)});
  for (const Shape& shape : {make_difference(box, ball), make_complement(box), box}) {
    const SampledDistance field = sample_shape(*shape, {.lower = Vec3(-1, -1, -1),
                                                        .upper = Vec3(1, 1, 1),
                                                        .spacing = 0.05,
                                                        .band = 0.2,
                                                        .cut = false,
                                                        .interpolation = Interpolation::quadratic});
    EXPECT_EQ(complaint(field), "");
  }
}

TEST(Sampling, DoesNotDependOnTheNumberOfThreads) {
  const SamplingBox box{.lower = Vec3(-1, -1, -1),
                        .upper = Vec3(1, 1, 1),
                        .spacing = 0.02,
                        .band = 0.1,
                        .cut = false};
  double told = 0.0;
  const SampledDistance alone = sample_shape(*ball, box);
  const SampledDistance shared = sample_shape(
      *ball, box, {.threads = 3, .progress = [&](double share) { told = std::max(told, share); }});
  EXPECT_EQ(alone.data().samples.copy(), shared.data().samples.copy());
  EXPECT_EQ(alone.data().brick, shared.data().brick);
  EXPECT_NEAR(told, 1.0, 1e-12);
}

TEST(Sampling, NamesThePlaceWhereASurfaceIsOpen) {
  // a hemisphere's shell without its base: below the missing base the inside leaks out
  const SampledDistance open = changed(
      sampled(ball), [](const Vec3& x, double phi) { return x[2] > 0 ? phi : std::abs(phi); });
  const std::string message = complaint(open);
  EXPECT_NE(message.find("body 'b': body not closed"), std::string::npos) << message;
  EXPECT_NE(message.find("jumps from"), std::string::npos) << message;
}

TEST(Sampling, RejectsAnUnsignedDistance) {
  const SampledDistance unsigned_field =
      changed(sampled(ball), [](const Vec3&, double phi) { return std::abs(phi); });
  EXPECT_NE(complaint(unsigned_field).find("not closed"), std::string::npos);
}

TEST(Sampling, RejectsAWrongSignOfOneBrick) {
  BrickSamples data = sample_shape(*ball, {.lower = Vec3(-1, -1, -1),
                                           .upper = Vec3(1, 1, 1),
                                           .spacing = 0.02,
                                           .band = 0.1,
                                           .cut = false})
                          .data();
  const auto inside = std::find_if(data.brick.begin(), data.brick.end(), [](std::int32_t entry) {
    return entry < 0 && bound_of_far_brick(entry) < 0;
  });
  ASSERT_NE(inside, data.brick.end());
  *inside = far_brick(-bound_of_far_brick(*inside));
  EXPECT_NE(complaint(SampledDistance(data)).find("jumps from"), std::string::npos);
}

TEST(Sampling, RejectsAFieldThatIsNoDistance) {
  const SampledDistance steep =
      changed(sampled(ball), [](const Vec3&, double phi) { return 1.5 * phi; });
  EXPECT_NE(complaint(steep).find("jumps from"), std::string::npos);
}

TEST(Sampling, ABodyThatLeavesTheBoxMustSaySo) {
  const Shape tube = make_shape(
      Cylinder{Vec3::Zero(), Vec3(0, 1, 0), 0.3, std::numeric_limits<double>::infinity()});
  EXPECT_NE(complaint(sampled(tube)).find("--allow-cut"), std::string::npos);
  EXPECT_EQ(complaint(sampled(tube, true)), "");
}

TEST(Sampling, ABodyOutsideOfTheBoxIsAnError) {
  const Shape far_ball = make_shape(Sphere{Vec3(5, 0, 0), 0.5});
  EXPECT_NE(complaint(sampled(far_ball)).find("no sample lies inside"), std::string::npos);
  EXPECT_NE(complaint(sampled(make_complement(far_ball))).find("no sample lies outside"),
            std::string::npos);
}

TEST(Sampling, RoundsTheBoxUpToWholeBricks) {
  const SampledDistance field = sampled(ball);  // (2 / 0.05 + 3) / 4 bricks
  EXPECT_EQ(field.data().bricks, (Index3{11, 11, 11}));
  const SampledDistance odd = sample_shape(*ball, {.lower = Vec3(-1, -1, -1),
                                                   .upper = Vec3(1, 1.06, 1),
                                                   .spacing = 0.05,
                                                   .band = 0.2,
                                                   .cut = false});
  EXPECT_EQ(odd.data().bricks, (Index3{11, 12, 11}));
  EXPECT_GE(odd.upper()[1], 1.06);
}

TEST(Sampling, ASampledFieldCanBeSampledAgainWithinItsBand) {
  const SampledDistance first = sampled(ball);
  SamplingBox box{.lower = Vec3(-1, -1, -1),
                  .upper = Vec3(1, 1, 1),
                  .spacing = 0.07,
                  .band = 0.2,
                  .cut = false};
  const SampledDistance second = sample_shape(first, box);
  EXPECT_EQ(complaint(second), "");
  EXPECT_NEAR(second.distance(Vec3(0.6, 0.2, 0)), std::hypot(0.6, 0.2) - 0.5, 0.005);
  box.band = 0.21;
  EXPECT_THROW(sample_shape(first, box), UserError);
}

TEST(Sampling, RejectsEmptyAndOversizedBoxes) {
  SamplingBox box{
      .lower = Vec3::Zero(), .upper = Vec3(1, 0, 1), .spacing = 0.1, .band = 1, .cut = false};
  EXPECT_THROW(sample_shape(*ball, box), UserError);
  box.upper = Vec3(1, 1, 1);
  box.spacing = 1e-6;
  EXPECT_THROW(sample_shape(*ball, box), UserError);
}

}  // namespace
}  // namespace gasgrain
