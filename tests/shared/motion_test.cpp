#include "coupling/shared/motion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "coupling/shared/body.hpp"
#include "coupling/shared/primitives.hpp"
#include "tests/shared/error_checks.hpp"
#include "tests/shared/shape_checks.hpp"

namespace gasgrain {
namespace {

constexpr double pi = std::numbers::pi;

Motion motion(const std::string& keys) {
  return read_motion(ConfigTable::parse("motion = {" + keys + "}", "case.toml").table("motion"));
}

std::string complaint(const std::string& keys) {
  return user_error([&] { motion(keys); });
}

void expect_near(const Vec3& a, const Vec3& b, double tolerance = 1e-14) {
  EXPECT_LT((a - b).norm(), tolerance) << a.transpose() << " instead of " << b.transpose();
}

TEST(Motion, translates_between_start_and_stop) {
  const Motion m = motion("translate = {velocity = [1, 0, -2]}, start = 1, stop = 3");
  const Vec3 x(0.1, 0.2, 0.3);
  expect_near(m.pose(0.5).to_world(x), x);
  expect_near(m.pose(2.0).to_world(x), x + Vec3(1, 0, -2));
  expect_near(m.pose(9.0).to_world(x), x + Vec3(2, 0, -4));
  expect_near(m.velocity_at(x, 0.5), Vec3::Zero());
  expect_near(m.velocity_at(x, 2.0), Vec3(1, 0, -2));
  expect_near(m.velocity_at(x, 3.0), Vec3::Zero());
  EXPECT_TRUE(m.moves_between(0.9, 1.1));
  EXPECT_FALSE(m.moves_between(0.5, 1.0));
  EXPECT_FALSE(m.moves_between(3.0, 4.0));
}

TEST(Motion, rotates_right_handed_about_an_axis_off_the_origin) {
  const Motion m = motion("rotate = {point = [1, 0, 5], axis = [0, 0, 2], rate = 3}");
  const double quarter = 0.5 * pi / 3;
  expect_near(m.pose(quarter).to_world(Vec3(2, 0, 7)), Vec3(1, 1, 7));
  expect_near(m.velocity_at(Vec3(1, 1, 7), quarter), Vec3(-3, 0, 0));
  expect_near(m.pose(quarter).to_body(Vec3(1, 1, 7)), Vec3(2, 0, 7));
}

TEST(Motion, oscillates_with_the_stated_phase_from_where_it_is) {
  const Motion m = motion("oscillate = {amplitude = [0, 0.2, 0], frequency = 4, phase = 0.7}");
  EXPECT_DOUBLE_EQ(m.period, 0.25);
  expect_near(m.displacement(0.0), Vec3::Zero());
  expect_near(m.displacement(0.25), Vec3::Zero());
  const double t = 0.03;
  expect_near(m.displacement(t), Vec3(0, 0.2 * (std::sin(8 * pi * t + 0.7) - std::sin(0.7)), 0));
  expect_near(m.velocity_at(Vec3::Zero(), t), Vec3(0, 1.6 * pi * std::cos(8 * pi * t + 0.7), 0));
}

TEST(Motion, velocity_is_the_derivative_of_the_path_of_a_material_point) {
  const Motion m = motion(
      "translate = {velocity = [0.3, -0.1, 0.2]}, "
      "oscillate = {amplitude = [0.05, 0.02, -0.1], period = 0.8, phase = 1.1}, "
      "rotate = {point = [0.2, 0.4, -0.3], axis = [1, 2, -2], rate = -5}, start = 0.1");
  const Vec3 x0(0.7, -0.2, 0.5);
  const double step = 1e-6;
  for (const double t : {0.2, 0.5, 1.3}) {
    const Vec3 path = (m.pose(t + step).to_world(x0) - m.pose(t - step).to_world(x0)) / (2 * step);
    expect_near(m.velocity_at(m.pose(t).to_world(x0), t), path, 1e-8);
  }
}

TEST(Motion, moved_shape_keeps_distances_and_an_exact_gradient) {
  const Motion m = motion(
      "translate = {velocity = [0.3, -0.1, 0.2]}, "
      "rotate = {point = [0.2, 0, 0], axis = [1, 1, 0], rate = 2}");
  const Shape box = make_shape(Box{.center = Vec3(0.1, 0, 0), .half_size = Vec3(0.3, 0.2, 0.1)});
  const Pose pose = m.pose(0.7);
  const Shape moved = move_shape(box, pose);
  RandomPoints points(Vec3::Constant(-0.6), Vec3::Constant(0.6));
  for (int n = 0; n < 100; ++n) {
    const Vec3 x0 = points.next();
    EXPECT_NEAR(moved->distance(pose.to_world(x0)), box->distance(x0), 1e-15);
  }
  expect_exact_gradient(*moved, points);
}

TEST(Motion, surface_only_moves_the_surface_and_nothing_else) {
  const Body roll =
      read_bodies(ConfigTable::parse("[[body]]\nname = 'roll'\n"
                                     "cylinder = {point=[1,0,0], axis=[0,1,0], radius=0.5}\n"
                                     "motion = {rotate = {point=[1,0,0], axis=[0,1,0], rate=4}, "
                                     "surface_only = true}",
                                     "case.toml"),
                  nullptr)
          .front();
  EXPECT_FALSE(roll.motion.sweeps());
  EXPECT_EQ(shape_at(roll, 3.0), roll.shape);
  expect_near(surface_velocity_at(roll, Vec3(1, 9, 0.5), 3.0), Vec3(2, 0, 0));
}

TEST(Motion, surface_velocity_turns_with_the_body) {
  Body belt;
  belt.surface_velocity = Vec3(0.5, 0, 0);
  belt.motion = motion("rotate = {point = [0, 0, 0], axis = [0, 0, 1], rate = 1}");
  expect_near(surface_velocity_at(belt, Vec3::Zero(), 0.5 * pi), Vec3(0, 0.5, 0));
}

TEST(Motion, every_error_names_the_key) {
  expect_contains(complaint("start = 1"), "motion.rotate: is missing");
  expect_contains(complaint("rotate = {point=[0,0,0], axis=[0,0,0], rate=1}"), "must not be zero");
  expect_contains(complaint("oscillate = {amplitude=[1,0,0], period=0}"), "oscillate.period");
  expect_contains(complaint("oscillate = {amplitude=[1,0,0], period=1, frequency=1}"),
                  "give one of them");
  expect_contains(complaint("translate = {velocity=[1,0,0]}, start = 2, stop = 1"), "motion.stop");
  expect_contains(complaint("translat = {velocity=[1,0,0]}"), "did you mean 'translate'?");
  expect_contains(complaint("translate = {velocity=[1,0,0], rate = 2}"), "rate");
}

}  // namespace
}  // namespace gasgrain
