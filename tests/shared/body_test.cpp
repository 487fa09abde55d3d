#include "coupling/shared/body.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "coupling/shared/primitives.hpp"
#include "tests/shared/error_checks.hpp"

namespace gasgrain {
namespace {

Shape no_loader(const std::string& path) {
  throw UserError("cannot load " + path);
}

std::vector<Body> bodies(const std::string& text, ShapeFileLoader loader = no_loader) {
  return read_bodies(ConfigTable::parse(text, "case.toml"), loader);
}

// A case with one body named b and these further lines.
Body body(const std::string& lines) {
  return bodies("[[body]]\nname = \"b\"\n" + lines).front();
}

std::string complaint(const std::string& lines) {
  return user_error([&] { body(lines); });
}

TEST(Body, ReadsEveryPrimitive) {
  EXPECT_DOUBLE_EQ(body("plane = {point = [0,0,1], normal = [0,0,2]}").shape->distance({0, 0, 4}),
                   3);
  EXPECT_DOUBLE_EQ(body("box = {lower = [0,0,0], upper = [2,1,1]}").shape->distance({4, 0.5, 0.5}),
                   2);
  EXPECT_DOUBLE_EQ(body("sphere = {center = [1,1,1], radius = 2}").shape->distance({1, 1, 5}), 2);
  EXPECT_DOUBLE_EQ(
      body("cylinder = {point = [0,0,0], axis = [0,3,0], radius = 1}").shape->distance({3, 100, 0}),
      2);
  EXPECT_DOUBLE_EQ(body("cylinder = {point = [0,0,0], axis = [0,3,0], radius = 1, half_length = 2}")
                       .shape->distance({0, 5, 0}),
                   3);
  EXPECT_DOUBLE_EQ(
      body("cylinder = {start = [0,0,0], end = [0,0,4], radius = 1}").shape->distance({0, 0, 7}),
      3);
}

TEST(Body, RotatesABoxAboutItsCentre) {
  // an edge of 2 along x, turned by 90 degrees about z through (1, 0.5, 0.5), lies along y
  const Body turned = body(
      "box = {lower = [0,0,0], upper = [2,1,1], rotation_axis = [0,0,5], rotation_angle = 90}");
  EXPECT_NEAR(turned.shape->distance({1, 2.5, 0.5}), 1, 1e-14);
  EXPECT_NEAR(turned.shape->distance({2.5, 0.5, 0.5}), 1, 1e-14);
  // by 45 degrees anticlockwise the corner (2, 1) is nearest to straight up
  const Body oblique = body(
      "box = {lower = [-1,-1,-1], upper = [1,1,1], rotation_axis = [0,0,1], rotation_angle = 45}");
  EXPECT_NEAR(oblique.shape->distance({2, 0, 0}), 2 - std::sqrt(2.0), 1e-14);
  const Body slightly = body(
      "box = {lower = [-9,-1,-9], upper = [9,1,9], rotation_axis = [0,0,1], rotation_angle = 30}");
  EXPECT_NEAR(slightly.shape->distance({-1.5, 1.5 * std::sqrt(3.0), 0}), 2, 1e-14);
}

TEST(Body, ReadsNestedBooleans) {
  const Body shape = body(
      "difference = [{box = {lower = [-1,-1,-1], upper = [1,1,1]}},\n"
      "  {sphere = {center = [1,0,0], radius = 0.5}},\n"
      "  {intersection = [{sphere = {center = [-1,0,0], radius = 0.5}},\n"
      "                   {complement = {plane = {point = [0,0,0], normal = [0,0,1]}}}]}]");
  EXPECT_LT(shape.shape->distance({0, 0, 0}), 0);
  EXPECT_GT(shape.shape->distance({0.9, 0, 0}), 0);
  EXPECT_GT(shape.shape->distance({-0.9, 0, 0.1}), 0);
  EXPECT_LT(shape.shape->distance({-0.9, 0, -0.1}), 0);
  const Body both = body(
      "union = [{sphere = {center = [0,0,0], radius = 1}},"
      " {sphere = {center = [5,0,0], radius = 1}}]");
  EXPECT_DOUBLE_EQ(both.shape->distance({3.5, 0, 0}), 0.5);
}

TEST(Body, ActsOnBothUnlessTold) {
  const std::string ball = "sphere = {center = [0,0,0], radius = 1}\n";
  EXPECT_TRUE(body(ball).acts_on_gas && body(ball).acts_on_grains);
  const Body wall = body(ball + "acts_on = [\"grains\"]\nsurface_velocity = [0.1, 0, 0]");
  EXPECT_TRUE(!wall.acts_on_gas && wall.acts_on_grains);
  EXPECT_EQ(wall.surface_velocity, Vec3(0.1, 0, 0));
}

TEST(Body, SamplesOnRequest) {
  const Body ball = body(
      "sphere = {center = [0,0,0], radius = 1}\n"
      "spacing = 0.1\nlower = [-2,-2,-2]\nupper = [2,2,2]\nband = 0.5");
  EXPECT_EQ(ball.shape->resolved_range(), 0.5);
  EXPECT_NEAR(ball.shape->distance({1.2, 0.03, 0}), 0.2, 0.005);
  EXPECT_NE(ball.shape->distance({1.2, 0.03, 0}), std::hypot(1.2, 0.03) - 1);
}

TEST(Body, LoadsAFileRelativeToTheCase) {
  const auto directory = std::filesystem::temp_directory_path() / "gasgrain_body_test";
  std::filesystem::create_directories(directory);
  std::ofstream(directory / "ball.h5") << "x";
  std::ofstream(directory / "case.toml") << "[[body]]\nname = \"b\"\nfile = \"ball.h5\"\n";
  const auto loader = [](const std::string& path) -> Shape {
    EXPECT_TRUE(std::filesystem::equivalent(
        path, std::filesystem::temp_directory_path() / "gasgrain_body_test" / "ball.h5"));
    return make_shape(Sphere{Vec3::Zero(), 1.0});
  };
  const auto read = read_bodies(ConfigTable::parse_file(directory / "case.toml"), loader);
  EXPECT_DOUBLE_EQ(read.at(0).shape->distance({3, 0, 0}), 2);
  // the loader's own complaint is passed on with file, line and key
  expect_contains(
      user_error([&] { read_bodies(ConfigTable::parse_file(directory / "case.toml"), no_loader); }),
      "case.toml:3: body[1].file: cannot load");
  std::filesystem::remove_all(directory);
}

TEST(Body, EveryErrorNamesLineAndKey) {
  const std::string ball = "sphere = {center = [0,0,0], radius = 1}\n";
  expect_contains(user_error([] { bodies("[[body]]\nplane = {point=[0,0,0], normal=[0,0,1]}"); }),
                  "case.toml:1: body[1].name: is missing");
  expect_contains(user_error([&] {
                    bodies("[[body]]\nname = \"a\"\n" + ball + "[[body]]\nname = \"a\"\n" + ball);
                  }),
                  "case.toml:5: body[2].name: 'a' is taken");
  expect_contains(complaint(""), "is missing; give one of plane, box");
  expect_contains(complaint(ball + "plane = {point=[0,0,0], normal=[0,0,1]}"),
                  "a second shape beside");
  expect_contains(complaint("sphere = {center = [0,0,0], radius = 0}"),
                  "case.toml:3: body[1].sphere.radius: is 0, but must be in (0");
  expect_contains(complaint("cylinder = {point=[0,0,0], axis=[0,0,0], radius=1}"),
                  "cylinder.axis: must not be zero");
  expect_contains(complaint("plane = {point=[0,0,0], normal=[0,0,0]}"),
                  "plane.normal: must not be zero");
  expect_contains(complaint("box = {lower=[0,0,0], upper=[1,0,1]}"),
                  "box.upper: is (1, 0, 1), but must exceed `lower` = (0, 0, 0)");
  expect_contains(complaint("cylinder = {start=[0,0,1], end=[0,0,1], radius=1}"),
                  "cylinder.end: must differ");
  expect_contains(complaint("cylinder = {point=[0,0,0], axis=[0,0,1], radius=1, half_length=-1}"),
                  "half_length: is -1");
  expect_contains(complaint("union = []"), "union: needs at least 1 shape");
  expect_contains(complaint("difference = [{" + std::string("sphere={center=[0,0,0],radius=1}}]")),
                  "difference: needs at least 2 shapes");
  expect_contains(complaint("file = \"nowhere.h5\""), "'nowhere.h5', which is not there");
  expect_contains(complaint(ball + "acts_on = [\"grain\"]"), "holds 'grain'");
  expect_contains(complaint(ball + "acts_on = []"), "acts_on: is empty");
  expect_contains(complaint(ball + "lower = [0,0,0]"), "give `spacing` as well");
}

TEST(Body, UnknownKeysSuggestTheNearest) {
  const std::string ball = "sphere = {center = [0,0,0], radius = 1}\n";
  expect_contains(complaint("spere = {center = [0,0,0], radius = 1}"), "did you mean 'sphere'?");
  expect_contains(complaint("sphere = {centre = [0,0,0], center = [0,0,0], radius = 1}"),
                  "did you mean 'center'?");
  expect_contains(complaint(ball + "act_on = [\"gas\"]"), "did you mean 'acts_on'?");
  expect_contains(complaint("union = [{sphere = {center=[0,0,0], radius=1}, colour = 1}]"),
                  "body[1].union[1].colour: is not a known key");
}

TEST(Body, ASampledBodyMustBeClosedInItsBox) {
  expect_contains(complaint("cylinder = {point=[0,0,0], axis=[0,1,0], radius=0.5}\n"
                            "spacing = 0.1\nlower = [-1,-1,-1]\nupper = [1,1,1]"),
                  "body not closed");
  EXPECT_EQ(complaint("cylinder = {point=[0,0,0], axis=[0,1,0], radius=0.5}\n"
                      "spacing = 0.1\nlower = [-1,-1,-1]\nupper = [1,1,1]\ncut = true"),
            "no error");
  expect_contains(complaint("sphere = {center=[9,0,0], radius=0.5}\n"
                            "spacing = 0.1\nlower = [-1,-1,-1]\nupper = [1,1,1]"),
                  "no sample lies inside");
}

TEST(Body, IsFoundByName) {
  const auto list = bodies(
      "[[body]]\nname = \"tubes\"\nsphere = {center = [0,0,0], radius = 1}\n"
      "[[body]]\nname = \"vessel\"\nsphere = {center = [0,0,0], radius = 1}\n");
  EXPECT_EQ(&find_body(list, "vessel"), &list[1]);
  const std::string message = user_error([&] { find_body(list, "vesel"); });
  expect_contains(message, "no body 'vesel'");
  expect_contains(message, "tubes, vessel");
  expect_contains(message, "did you mean 'vessel'?");
}

TEST(Body, ACaseWithoutBodiesHasNone) {
  EXPECT_TRUE(bodies("[grid]\n").empty());
}

}  // namespace
}  // namespace gasgrain
