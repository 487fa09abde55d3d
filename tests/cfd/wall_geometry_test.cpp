#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "cfd/open_fraction.hpp"
#include "coupling/shared/sampling.hpp"
#include "tests/cfd/gas_fixture.hpp"
#include "tests/shared/error_checks.hpp"

namespace gasgrain::cfd {
namespace {

using testing::bodies;

TEST(PlaneCut, fraction_of_an_axis_parallel_cut_is_linear) {
  const Vec3 half(0.5, 1.0, 2.0);
  for (const double distance : {-0.6, -0.2, 0.0, 0.3, 0.5, 0.9}) {
    const double expected = std::clamp(0.5 + distance, 0.0, 1.0);
    EXPECT_NEAR(plane_cut_fraction(distance, Vec3(1, 0, 0), half), expected, 1e-14);
  }
}

TEST(PlaneCut, corner_cut_is_the_tetrahedron) {
  // plane x + y + z = 3 - t cuts a tetrahedron of volume t^3/6 off the cube [-1,1]^3
  const double t = 0.7;
  const double distance = 3.0 - t;
  EXPECT_NEAR(1.0 - plane_cut_fraction(distance, Vec3(-1, -1, -1), Vec3::Ones()), t * t * t / 48.0,
              1e-13);
}

TEST(PlaneCut, both_sides_add_up_to_one) {
  for (int n = 0; n < 200; ++n) {
    const Vec3 normal =
        Vec3(std::sin(n * 1.1), std::cos(n * 2.3), std::sin(0.7 * n + 1)).normalized();
    const double distance = 0.8 * std::sin(3.7 * n);
    const Vec3 half(1.0, 0.4, n % 3 == 0 ? 0.0 : 0.8);
    EXPECT_NEAR(
        plane_cut_fraction(distance, normal, half) + plane_cut_fraction(-distance, -normal, half),
        1.0, 1e-12);
  }
}

WallGeometry geometry(const GasCase& gas_case) {
  const Decomposition blocks(MPI_COMM_WORLD, gas_case.grid,
                             periodic_directions(gas_case.boundaries));
  return make_wall_geometry(blocks, SideConditions(gas_case.grid, gas_case.boundaries),
                            gas_case.bodies);
}

TEST(OpenFraction, volume_of_a_sphere_is_exact_to_a_permille) {
  const Body ball = bodies("[[body]]\nname='s'\nsphere={center=[0.51,0.48,0.5],radius=0.3}\n")[0];
  const double h = 1.0 / 20;
  double solid = 0.0;
  for_each_cell({20, 20, 20}, [&](int i, int j, int k) {
    const Vec3 centre(h * (i + 0.5), h * (j + 0.5), h * (k + 0.5));
    solid += h * h * h * (1.0 - open_fraction(*ball.shape, centre, Vec3::Constant(0.5 * h)));
  });
  EXPECT_NEAR(solid / (4.0 / 3.0 * std::numbers::pi * 0.027), 1.0, 1e-3);
}

TEST(OpenFraction, open_faces_of_a_cut_box_balance_its_wall) {
  // The outward areas of a closed surface add up to nothing: those of the open faces of a cut box
  // are opposite to the wall's, which is along its normal.
  const Body wall = bodies("[[body]]\nname='p'\nplane={point=[0.3,0.5,0.41],normal=[1,2,2]}\n")[0];
  const Vec3 normal = Vec3(1, 2, 2).normalized(), half(0.05, 0.08, 0.04);
  int cut = 0;
  for (int n = 0; n < 100; ++n) {
    const Vec3 centre =
        Vec3(0.3, 0.5, 0.41) + 0.06 * Vec3(std::sin(n), std::sin(2.1 * n), std::cos(n));
    const double open = open_fraction(*wall.shape, centre, half);
    if (open == 0.0 || open == 1.0) continue;
    ++cut;
    Vec3 sum = Vec3::Zero();
    for (int d = 0; d < 3; ++d) {
      Vec3 face = half;
      face[d] = 0.0;
      const double area = half.prod() / half[d];
      for (const double sign : {-1.0, 1.0}) {
        const Vec3 middle = centre + sign * half[d] * Vec3::Unit(d);
        sum[d] += sign * area * open_fraction(*wall.shape, middle, face);
      }
    }
    EXPECT_LT(sum.cross(normal).norm(), 1e-12 * half.norm());
    EXPECT_GT(sum.dot(normal), 0.0);
  }
  EXPECT_GT(cut, 20);
}

TEST(WallGeometry, shares_are_halves_inside_and_all_on_the_free_face_at_walls_and_inlets) {
  GasCase c = testing::box_case(Vec3(1, 1, 1), {4, 1, 4});
  c.boundaries[2][0] = testing::inlet(Vec3(0, 0, 1));
  c.boundaries[2][1] = testing::side(BoundaryType::outlet);
  const Decomposition blocks(MPI_COMM_WORLD, c.grid, {false, false, false});
  const WallGeometry walls =
      make_wall_geometry(blocks, SideConditions(c.grid, c.boundaries), c.bodies);
  for_each_cell(blocks.block().size, [&](int i, int j, int k) {
    const int x = i + blocks.block().lower[0], z = k + blocks.block().lower[2];
    EXPECT_EQ(walls.lower_share[0](i, j, k), x == 0 ? 0.0 : x == 3 ? 1.0 : 0.5);
    EXPECT_EQ(walls.upper_share[0](i, j, k), x == 3 ? 0.0 : x == 0 ? 1.0 : 0.5);
    EXPECT_EQ(walls.lower_share[1](i, j, k) + walls.upper_share[1](i, j, k), 0.0);
    EXPECT_EQ(walls.lower_share[2](i, j, k), z == 0 ? 0.0 : 0.5);
    EXPECT_EQ(walls.upper_share[2](i, j, k), z == 0 ? 1.0 : 0.5);
  });
}

TEST(WallGeometry, a_body_outside_the_grid_is_a_user_error_that_names_it) {
  GasCase c = testing::box_case(Vec3(1, 1, 1), {4, 4, 4});
  c.bodies = bodies("[[body]]\nname='far'\nsphere={center=[3,0,0],radius=0.5}\n");
  expect_contains(user_error([&] { geometry(c); }), "body 'far' acts on the gas but no part");
  c.bodies =
      bodies("[[body]]\nname='far'\nacts_on=['grains']\nsphere={center=[3,0,0],radius=0.5}\n");
  EXPECT_FALSE(geometry(c).has_bodies);
}

TEST(WallGeometry, a_sampled_body_with_a_band_below_two_cells_is_a_user_error) {
  GasCase c = testing::box_case(Vec3(1, 1, 1), {8, 8, 8});
  c.bodies = bodies("[[body]]\nname='ball'\nsphere={center=[0.5,0.5,0.5],radius=0.25}\n");
  const Shape exact = c.bodies[0].shape;
  const auto sampled = [&](double band) {
    return std::make_shared<SampledDistance>(sample_shape(*exact, {.lower = Vec3(0, 0, 0),
                                                                   .upper = Vec3(1, 1, 1),
                                                                   .spacing = 0.02,
                                                                   .band = band,
                                                                   .cut = false}));
  };
  c.bodies[0].shape = sampled(0.2);
  const std::string error = user_error([&] { geometry(c); });
  expect_contains(error, "'ball'");
  expect_contains(error, "0.25");
  c.bodies[0].shape = sampled(0.3);
  EXPECT_TRUE(geometry(c).has_bodies);
}

TEST(WallGeometry, a_body_that_fills_the_grid_is_a_user_error) {
  GasCase c = testing::box_case(Vec3(1, 1, 1), {4, 4, 4});
  c.bodies = bodies("[[body]]\nname='all'\nsphere={center=[0.5,0.5,0.5],radius=5}\n");
  expect_contains(user_error([&] { geometry(c); }), "the bodies fill the whole gas grid");
}

TEST(WallGeometry, gas_that_cannot_move_counts_as_solid) {
  // The floor leaves a sliver of 0.05 cells above it: its face centres are inside the floor.
  GasCase c = testing::box_case(Vec3(1, 1, 1), {10, 1, 10});
  c.bodies = bodies(
      "[[body]]\nname='f'\nunion=[{box={lower=[-1,-1,-1],upper=[2,2,0.295]}},"
      "{box={lower=[-1,-1,0.3],upper=[2,2,0.5]}}]\n");
  const Decomposition blocks(MPI_COMM_WORLD, c.grid, {false, false, false});
  const WallGeometry walls =
      make_wall_geometry(blocks, SideConditions(c.grid, c.boundaries), c.bodies);
  for_each_cell(blocks.block().size, [&](int i, int j, int k) {
    EXPECT_EQ(walls.wall_fraction(i, j, k), k + blocks.block().lower[2] < 5 ? 1.0 : 0.0);
  });
}

}  // namespace
}  // namespace gasgrain::cfd
