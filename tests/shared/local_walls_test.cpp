#include "coupling/shared/local_walls.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "coupling/shared/boolean_shapes.hpp"
#include "coupling/shared/primitives.hpp"
#include "coupling/shared/sampling.hpp"

namespace gasgrain {
namespace {

constexpr double radius = 1.0, spacing = 0.25;

// A round cavity with a ring that grows out of its wall: hollow, saddle and concave edges.
Shape cavity() {
  return make_union({make_complement(make_shape(Sphere{Vec3(0.03, -0.07, 0.05), 6.0})),
                     make_shape(Torus{.center = Vec3(0.1, 0.2, -0.1),
                                      .axis = Vec3(1, 2, 3).normalized(),
                                      .radius = 5.2,
                                      .tube_radius = 1.6})});
}

const Shape& sampled_cavity() {
  static const Shape shape = std::make_shared<const SampledDistance>(
      sample_shape(*cavity(), {.lower = Vec3::Constant(-7),
                               .upper = Vec3::Constant(7),
                               .spacing = spacing,
                               .band = 2.0,
                               .cut = true,
                               .interpolation = Interpolation::quadratic}));
  return shape;
}

// Places of a ball that overlaps a wall a little.
template <class Visit>
void visit_contacts(int count, const Visit& visit) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(-6.0, 6.0);
  for (int found = 0; found < count;) {
    const Vec3 x(place(random), place(random), place(random));
    const double gap = cavity()->distance(x) - radius;
    if (gap < -0.03 || gap > 0.0) continue;
    ++found;
    visit(x, Vec3(place(random), place(random), place(random)).normalized());
  }
}

// The walls that a ball at x sees, wherever it came from.
LocalWalls walls_at(const Vec3& x) {
  LocalWalls walls;
  walls.come_to(*sampled_cavity(), x, radius);
  return walls;
}

TEST(LocalWalls, tell_the_distance_of_the_surface) {
  double worst = 0.0, sum = 0.0;
  constexpr int count = 2000;
  visit_contacts(count, [&](const Vec3& x, const Vec3&) {
    const LocalWalls walls = walls_at(x);
    ASSERT_GE(walls.count(), 1);
    double nearest = 10.0;
    for (int n = 0; n < walls.count(); ++n)
      nearest = std::min(nearest, walls.seen_from(x, n).distance);
    const double error = std::abs(nearest - cavity()->distance(x));
    worst = std::max(worst, error);
    sum += error;
  });
  EXPECT_LT(worst, 1e-3 * spacing);
  EXPECT_LT(sum / count, 1e-4 * spacing);
}

// On a straight way through contacts the distance jumps from cube to cube by the error of the
// quadratic functions alone.
TEST(LocalWalls, hardly_jump_between_cubes) {
  double worst = 0.0;
  visit_contacts(200, [&](const Vec3& x, const Vec3& direction) {
    constexpr double step = 1e-9;
    LocalWalls walls = walls_at(x);
    for (int n = 1; n <= 100; ++n) {
      const Vec3 before = x + n * 1e-4 * direction, after = before + step * direction;
      walls.come_to(*sampled_cavity(), before, radius);
      if (walls.count() != 1) continue;
      const double distance = walls.seen_from(before, 0).distance;
      walls.come_to(*sampled_cavity(), after, radius);
      if (walls.count() == 1)
        worst = std::max(worst, std::abs(walls.seen_from(after, 0).distance - distance));
    }
  });
  EXPECT_LT(worst, 1e-5 * spacing);
}

TEST(LocalWalls, do_not_depend_on_where_the_ball_came_from) {
  visit_contacts(300, [](const Vec3& x, const Vec3& direction) {
    LocalWalls known;
    for (int n = 20; n >= 0; --n)
      known.come_to(*sampled_cavity(), x + n * 3e-4 * direction, radius);
    const LocalWalls fresh = walls_at(x);
    ASSERT_EQ(known.count(), fresh.count());
    for (int n = 0; n < known.count(); ++n) {
      EXPECT_EQ(known.seen_from(x, n).distance, fresh.seen_from(x, n).distance);
      EXPECT_EQ(known.seen_from(x, n).gradient, fresh.seen_from(x, n).gradient);
    }
  });
}

TEST(LocalWalls, give_the_gradient_of_the_distance_that_they_tell) {
  visit_contacts(100, [](const Vec3& x, const Vec3&) {
    constexpr double step = 1e-4;
    const LocalWalls walls = walls_at(x);
    for (int n = 0; n < walls.count(); ++n)
      for (int d = 0; d < 3; ++d) {
        const Vec3 aside = step * Vec3::Unit(d);
        const double slope =
            (walls.seen_from(x + aside, n).distance - walls.seen_from(x - aside, n).distance) /
            (2 * step);
        EXPECT_NEAR(walls.seen_from(x, n).gradient[d], slope, 1e-10);
      }
  });
}

TEST(LocalWalls, have_the_curvature_of_a_round_wall) {
  constexpr double pipe = 4.0;
  const Shape field = std::make_shared<const SampledDistance>(
      sample_shape(*make_complement(make_shape(Sphere{Vec3(0.1, 0.2, 0.3), pipe})),
                   {.lower = Vec3::Constant(-5),
                    .upper = Vec3::Constant(5),
                    .spacing = spacing,
                    .band = 2.0,
                    .cut = true,
                    .interpolation = Interpolation::quadratic}));
  const Vec3 out = Vec3(2, -1, 3).normalized(), x = Vec3(0.1, 0.2, 0.3) + 3.0 * out;
  NearWalls found;
  add_near_walls(*field, x, 1.1, found);
  ASSERT_EQ(found.count, 1);
  const Mat3 expected = -(Mat3::Identity() - out * out.transpose()) / 3.0;
  EXPECT_LT((found.surface[0].curvature - expected).norm(), 0.05 / 3.0);
  EXPECT_LT((found.surface[0].gradient + out).norm(), 1e-3);
  EXPECT_NEAR(found.surface[0].distance, 1.0, 1e-4);
}

TEST(LocalWalls, know_how_far_a_distant_ball_can_go) {
  const Vec3 x(0.1, 0.2, 0.3);
  const LocalWalls walls = walls_at(x);
  EXPECT_EQ(walls.count(), 0);
  const double way = walls.way_left(x);
  EXPECT_GT(way, 0.1);
  visit_contacts(50, [&](const Vec3& contact, const Vec3&) {
    EXPECT_GT((contact - x).norm(), way);  // no contact before
  });
}

// An exact shape has no curvature to tell, so that it is looked at anew in every step.
TEST(LocalWalls, of_exact_shapes_are_exact_everywhere) {
  visit_contacts(20, [](const Vec3& x, const Vec3& direction) {
    LocalWalls walls;
    for (const double way : {0.0, 1e-4}) {
      const Vec3 there = x - way * direction;
      walls.come_to(*cavity(), there, radius);
      ASSERT_GE(walls.count(), 1);
      EXPECT_NEAR(walls.seen_from(there, 0).distance, cavity()->distance(there), 1e-12);
    }
  });
}

// In a box of 6.
SampledDistance samples_of(const SignedDistance& shape, bool cut) {
  return sample_shape(shape, {.lower = Vec3::Constant(-3),
                              .upper = Vec3::Constant(3),
                              .spacing = spacing,
                              .band = 2.0,
                              .cut = cut,
                              .interpolation = Interpolation::quadratic});
}

// A floor with steep bumps, few spacings wide, among which a search may not end.
class RoughFloor : public SignedDistance {
 public:
  double distance(const Vec3& x) const override { return sample(x).distance; }
  DistanceSample sample(const Vec3& x) const override {
    const double u = bumps * x[0], v = bumps * x[1];
    return {x[2] - height * std::sin(u) * std::sin(v),
            {-height * bumps * std::cos(u) * std::sin(v),
             -height * bumps * std::sin(u) * std::cos(v), 1.0}};
  }

 private:
  static constexpr double height = 2.0 * spacing, bumps = 1.2 / spacing;
};

// Of a search that was given up the wall says so; the others have led to a foot.
TEST(LocalWalls, say_whether_the_nearest_place_was_found) {
  const SampledDistance field = samples_of(RoughFloor(), true);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> share(-1.0, 1.0);
  int found = 0, given_up = 0;
  for (int n = 0; n < 2000; ++n) {
    const Vec3 x(share(random), share(random), 0.8 * radius);
    LocalWalls walls;
    walls.come_to(field, x, radius);
    for (int w = 0; w < walls.count(); ++w) {
      const DistanceSample wall = walls.seen_from(x, w);
      const DistanceSample foot = field.sample(x - wall.distance * wall.gradient);
      if (!walls.foot_found(w)) {
        ++given_up;
        continue;
      }
      ++found;
      EXPECT_NEAR(foot.distance, 0.0, 1e-3 * spacing);
      EXPECT_GT(wall.gradient.dot(foot.gradient.normalized()), 1 - 1e-6);
    }
  }
  EXPECT_GT(found, 2000);
  EXPECT_GT(given_up, 20);
}

// The hole of this ring is exactly as wide as the ball: its centre on the axis is equally far from
// the whole inner circle. There the ball must always see a wall, and hardly ever does the search
// for its foot end before one is found.
TEST(LocalWalls, are_never_lost_in_a_hole_as_wide_as_the_ball) {
  const Vec3 axis = Vec3(1, 2, 3).normalized(), across = axis.unitOrthogonal();
  const Shape ring =
      make_shape(Torus{.center = Vec3::Zero(), .axis = axis, .radius = 1.8, .tube_radius = 0.8});
  const SampledDistance field = samples_of(*ring, false);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> share(-1.0, 1.0);
  int unsure = 0;
  for (int n = 0; n < 1000; ++n) {
    const Vec3 x = 0.02 * (share(random) * across + share(random) * axis.cross(across)) +
                   0.2 * share(random) * axis;
    if (ring->distance(x) > 0.995 * radius) continue;
    LocalWalls walls;
    walls.come_to(field, x, radius);
    ASSERT_GE(walls.count(), 1);
    double nearest = 10.0;
    for (int w = 0; w < walls.count(); ++w) {
      const DistanceSample wall = walls.seen_from(x, w);
      nearest = std::min(nearest, wall.distance);
      unsure += !walls.foot_found(w);
    }
    EXPECT_NEAR(nearest, ring->distance(x), 0.02 * radius);
  }
  EXPECT_LE(unsure, 1);
}

}  // namespace
}  // namespace gasgrain
