#include "cfd/side_conditions.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "tests/shared/error_checks.hpp"

namespace gasgrain::cfd {
namespace {

// Path of a file that lies beside the case file.
std::string scratch(const std::string& name) {
  const std::filesystem::path directory =
      std::filesystem::path(::testing::TempDir()) / "gasgrain_side_conditions";
  std::filesystem::create_directories(directory);
  return (directory / name).string();
}

void write(const std::string& name, const std::string& text) {
  std::ofstream(scratch(name)) << text;
}

const std::string no_slip_sides =
    "x_lower = {type = 'no-slip'}\nx_upper = {type = 'no-slip'}\ny_lower = {type = 'no-slip'}\n"
    "y_upper = {type = 'no-slip'}\nz_lower = {type = 'no-slip'}\nz_upper = {type = 'outlet'}\n";

std::string patch(const std::string& text) {
  return "[[patch]]\n" + text + "\n";
}

// The unit cube with n cells per direction and the given [boundary] table.
SideConditions sides_of(const std::string& text, int n = 10) {
  Grid grid{.lower = Vec3::Zero(), .upper = Vec3::Ones(), .cells = {n, n, n}};
  const ConfigTable table = ConfigTable::parse(text, scratch("case.toml"));
  const Boundaries boundaries = read_boundaries(table);
  return SideConditions(grid, boundaries, read_patches(table, boundaries, {}, nullptr));
}

void expect_error(const std::string& text, const std::string& part) {
  expect_contains(user_error([&] { sides_of(text); }), part);
}

std::string with_inlet(const std::string& inlet) {
  std::string text = no_slip_sides;
  const std::string old = "z_lower = {type = 'no-slip'}";
  return text.replace(text.find(old), old.size(), "z_lower = {type = 'inlet', " + inlet + "}");
}

double mean_inflow(const SideConditions& sides, int n = 10) {
  double sum = 0.0;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) sum += sides.velocity(2, 0, {i, j, 0})[2];
  }
  return sum / (n * n);
}

const std::string jet = patch(
    "name = 'jet'\nside = 'z_lower'\ntype = 'inlet'\nsuperficial_velocity = 3\n"
    "box = {lower = [0.3, 0.4, -1], upper = [0.5, 0.5, 1]}");

TEST(SideConditions, a_patch_holds_the_faces_whose_centre_is_in_its_shape) {
  const SideConditions sides = sides_of(no_slip_sides + jet);
  for (int i = 0; i < 10; ++i) {
    for (int j = 0; j < 10; ++j) {
      const bool inside = (i == 3 || i == 4) && j == 4;
      EXPECT_EQ(sides.at(2, 0, {i, j, 0}).type,
                inside ? BoundaryType::inlet : BoundaryType::no_slip);
    }
  }
  EXPECT_EQ(sides.parts().back().faces, 2);
  EXPECT_FALSE(sides.is_uniform(2, 0));
  EXPECT_TRUE(sides.is_uniform(2, 1));
  EXPECT_TRUE(sides.has(2, 0, BoundaryType::no_slip));
  EXPECT_FALSE(sides.has(0, 0, BoundaryType::inlet));
}

TEST(SideConditions, a_round_patch_covers_the_area_of_its_circle) {
  const SideConditions sides =
      sides_of(no_slip_sides + patch("name = 'vent'\nside = 'x_upper'\ntype = 'outlet'\n"
                                     "sphere = {center = [1, 0.5, 0.5], radius = 0.3}"),
               100);
  EXPECT_NEAR(sides.parts().back().faces * 1e-4, std::numbers::pi * 0.09, 2e-3);
}

TEST(SideConditions, cells_beyond_the_edge_have_the_nearest_face) {
  const SideConditions sides =
      sides_of(no_slip_sides + patch("name = 'corner'\nside = 'z_lower'\ntype = 'slip'\n"
                                     "box = {lower = [-1, -1, -1], upper = [0.1, 0.1, 1]}"));
  EXPECT_EQ(sides.at(2, 0, {-2, -1, 0}).type, BoundaryType::slip);
  EXPECT_EQ(sides.at(2, 0, {11, -1, 0}).type, BoundaryType::no_slip);
}

TEST(SideConditions, patches_that_cannot_be_are_errors) {
  expect_error(no_slip_sides + jet + jet, "is taken");
  std::string other = jet;
  expect_error(no_slip_sides + jet + other.replace(other.find("'jet'"), 5, "'air'"), "both hold");
  expect_error(no_slip_sides + patch("name = 'p'\nside = 'z_lower'\ntype = 'outlet'\n"
                                     "sphere = {center = [0.5, 0.5, 0.5], radius = 0.3}"),
               "holds the centre of no face");
  expect_error(no_slip_sides + patch("name = 'p'\nside = 'z_lower'\ntype = 'outlet'"),
               "<shape>: is missing");
  expect_error(no_slip_sides + patch("name = 'p'\nside = 'z_lower'\ntype = 'periodic'\n"
                                     "sphere = {center = [0.5, 0.5, 0], radius = 0.3}"),
               "must be one of");
  expect_error(no_slip_sides + patch("name = 'p'\nside = 'z_lower'\ntype = 'outlet'\n"
                                     "body = 'nozzle'"),
               "there is no body 'nozzle'");
  std::string periodic = no_slip_sides;
  for (const char* name : {"x_lower = {type = 'no-slip'}", "x_upper = {type = 'no-slip'}"}) {
    periodic.replace(periodic.find(name), std::string(name).size(),
                     std::string(name, 7) + " = {type = 'periodic'}");
  }
  expect_error(periodic + patch("name = 'p'\nside = 'x_lower'\ntype = 'outlet'\n"
                                "sphere = {center = [0, 0.5, 0.5], radius = 0.3}"),
               "which is periodic");
}

TEST(InletProfile, a_parabola_has_the_stated_mean_exactly_and_its_shape_to_second_order) {
  const SideConditions sides = sides_of(
      with_inlet("superficial_velocity = 0.2, profile = 'parabolic', profile_along = ['y']"));
  EXPECT_NEAR(mean_inflow(sides), 0.2, 1e-15);
  for (int j = 0; j < 10; ++j) {
    const double y = (j + 0.5) / 10.0;
    // the mean over a face exceeds the value in its middle by h^2/24 times the curvature
    const double expected = 1.2 * (y * (1 - y) - 0.01 / 12.0);
    EXPECT_NEAR(sides.velocity(2, 0, {3, j, 0})[2], expected, 1e-15);
  }
}

TEST(InletProfile, a_parabola_of_a_patch_spans_the_patch_in_both_directions) {
  const SideConditions sides = sides_of(
      no_slip_sides +
      patch("name = 'jet'\nside = 'z_lower'\ntype = 'inlet'\nsuperficial_velocity = 1\n"
            "profile = 'parabolic'\nbox = {lower = [0.2, 0.4, -1], upper = [0.4, 0.6, 1]}"));
  for (int i = 2; i < 4; ++i) {
    for (int j = 4; j < 6; ++j) EXPECT_NEAR(sides.velocity(2, 0, {i, j, 0})[2], 1.0, 1e-15);
  }
  EXPECT_EQ(sides.velocity(2, 0, {1, 4, 0})[2], 0.0);
}

TEST(InletProfile, a_file_is_integrated_exactly_over_the_faces) {
  // a kink in the middle of a face: the integral of the two lines is 0.26
  write("profile.csv", "# m, m/s\nx, velocity\n0, 0\n0.25, 0.4\n1.0, 0.16\n");
  const SideConditions sides = sides_of(with_inlet("profile_file = 'profile.csv'"));
  EXPECT_NEAR(mean_inflow(sides), 0.26, 1e-15);
  EXPECT_NEAR(sides.velocity(2, 0, {0, 7, 0})[2], 0.08, 1e-15);
  EXPECT_NEAR(sides.velocity(2, 0, {2, 0, 0})[2],
              0.5 * (0.4 - 0.025 * 1.6) + 0.5 * (0.4 - 0.025 * 0.32), 1e-15);
  const SideConditions scaled =
      sides_of(with_inlet("profile_file = 'profile.csv', superficial_velocity = 2.6"));
  EXPECT_NEAR(mean_inflow(scaled), 2.6, 1e-14);
  EXPECT_NEAR(scaled.velocity(2, 0, {0, 7, 0})[2], 0.8, 1e-14);
}

TEST(InletProfile, a_file_on_a_lattice_is_bilinear) {
  write("lattice.csv",
        "y,velocity,x\n0,1,0\n0,2,1\n1,3,0\n1,5,1\n");  // any order of columns
  const SideConditions sides = sides_of(with_inlet("profile_file = 'lattice.csv'"));
  const double x = 0.35, y = 0.85;
  EXPECT_NEAR(sides.velocity(2, 0, {3, 8, 0})[2], 1 + x + 2 * y + x * y, 1e-14);
}

TEST(InletProfile, files_that_do_not_fit_are_errors) {
  write("short.csv", "x,velocity\n0,1\n0.9,1\n");
  expect_error(with_inlet("profile_file = 'short.csv'"), "covers x from 0 to 0.9 m");
  write("gap.csv", "x,y,velocity\n0,0,1\n1,0,1\n0,1,1\n");
  expect_error(with_inlet("profile_file = 'gap.csv'"), "3 rows, but 4 make the full lattice");
  write("twice.csv", "x,velocity\n0,1\n0.5,1\n1,1\n0.5,2\n");
  expect_error(with_inlet("profile_file = 'twice.csv'"), "gives the position x = 0.5 m twice");
  write("out.csv", "x,velocity\n0,1\n1,-1\n");
  expect_error(with_inlet("profile_file = 'out.csv'"), "an inlet blows inwards");
  write("text.csv", "x,velocity\n0,1\n1,fast\n");
  expect_error(with_inlet("profile_file = 'text.csv'"),
               "text.csv:3: 'fast' is not a finite number");
  expect_error(with_inlet("profile_file = 'nowhere.csv'"), "cannot read");
  expect_error(with_inlet("superficial_velocity = 1, profile = 'parabolic', profile_along = ['z']"),
               "may hold 'x' and 'y'");
}

TEST(TimeTable, is_linear_between_its_rows_and_repeats_with_a_period) {
  const TimeTable ramp{.times = {0, 1, 3}, .values = {0, 2, 1}};
  EXPECT_DOUBLE_EQ(ramp.at(0.25), 0.5);
  EXPECT_DOUBLE_EQ(ramp.at(2.0), 1.5);
  EXPECT_DOUBLE_EQ(ramp.at(3.0), 1.0);
  EXPECT_FALSE(ramp.covers(3.1));
  const TimeTable wave{.times = {0, 1, 3}, .values = {0, 2, 1}, .period = 4};
  EXPECT_DOUBLE_EQ(wave.at(4.25), 0.5);
  EXPECT_DOUBLE_EQ(wave.at(7.5), 0.5);  // from the last row to the first of the next period
  EXPECT_TRUE(wave.covers(1e6));
}

TEST(TimeTable, scales_velocities_and_pressures_and_must_cover_the_time) {
  SideConditions sides = sides_of(
      with_inlet("superficial_velocity = 2, time_table = {times = [0, 1], values = [0, 1]}"));
  EXPECT_EQ(mean_inflow(sides), 0.0);
  sides.set_time(0.5);
  EXPECT_NEAR(mean_inflow(sides), 1.0, 1e-15);
  EXPECT_EQ(sides.largest_speeds(), Vec3(0, 0, 2));
  expect_contains(user_error([&] { sides.set_time(1.5); }), "ends at 1 s");
}

TEST(TimeTable, tables_that_cannot_be_are_errors) {
  const auto table = [](const std::string& text) {
    return with_inlet("superficial_velocity = 2, time_table = {" + text + "}");
  };
  expect_error(table("times = [0, 1], values = [1]"), "2 times and 1 values");
  expect_error(table("times = [0, 1, 1], values = [1, 1, 1]"), "do not increase");
  expect_error(table("times = [0.5, 1], values = [1, 1]"), "starts at 0.5");
  expect_error(table("times = [0, 1], values = [1, 1], period = 0.5"), "shorter than the table");
  expect_error(table("times = [0, 1], values = [1, -1]"), "an inlet blows inwards");
  expect_error(table("times = [0, 1], value = [1, 1]"), "did you mean 'values'");
  write("ramp.csv", "time,factor\n0,0\n1,1\n");
  EXPECT_NO_THROW(sides_of(table("file = 'ramp.csv'")));
}

}  // namespace
}  // namespace gasgrain::cfd
