#include "coupling/smoothing.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "cfd/loops.hpp"
#include "mapping_fixture.hpp"

namespace gasgrain::coupling {
namespace {

const Vec3 spline_variance = Vec3::Constant(0.25);  // of the quadratic B-spline, in dx^2

TEST(SmoothingPlan, reaches_the_width_with_the_fewest_sweeps) {
  const cfd::Grid grid{.lower = Vec3::Zero(), .upper = Vec3(1, 1, 1), .cells = {10, 10, 10}};
  for (const double width : {0.06, 0.08, 0.096, 0.25}) {
    const SmoothingPlan plan = plan_smoothing(grid, width, spline_variance);
    const double variance = 0.1 * 0.1 * (0.25 + 2 * plan.sweeps * plan.number[0]);
    EXPECT_NEAR(std::sqrt(variance), width, 1e-12);
    EXPECT_LE(plan.number.maxCoeff(), 0.125 + 1e-12);
    const double number_with_one_less =
        plan.sweeps > 1 ? plan.number[0] * plan.sweeps / (plan.sweeps - 1) : 1.0;
    EXPECT_GT(number_with_one_less, 0.125);
  }
}

TEST(SmoothingPlan, has_no_sweep_when_the_spline_is_wide_enough) {
  const cfd::Grid grid{.lower = Vec3::Zero(), .upper = Vec3(1, 1, 1), .cells = {10, 10, 10}};
  EXPECT_EQ(plan_smoothing(grid, 0.04, spline_variance).sweeps, 0);
}

TEST(SmoothingPlan, leaves_directions_of_one_cell_alone) {
  const cfd::Grid grid{.lower = Vec3::Zero(), .upper = Vec3(1, 0.1, 1), .cells = {10, 1, 10}};
  EXPECT_EQ(plan_smoothing(grid, 0.1, spline_variance).number[1], 0.0);
}

// Smooths a field through the form that Smoothing works on.
void smooth(cfd::Field& field, Smoothing& smoothing) {
  CellArray<1> cells(field.count());
  for (std::size_t n = 0; n < field.count(); ++n) cells[n][0] = field[n];
  smoothing.apply<1>(cells);
  cfd::for_each_cell(field.size(),
                     [&](int i, int j, int k) { field(i, j, k) = cells[field.index(i, j, k)][0]; });
}

// A field of random values in the open cells.
cfd::Field random_field(const MappingScene& scene, const Smoothing& smoothing) {
  cfd::Field field(scene.decomposition.block().size);
  const cfd::Block& block = scene.decomposition.block();
  cfd::for_each_cell(block.size, [&](int i, int j, int k) {
    const int n = (i + block.lower[0]) + 31 * (j + block.lower[1]) + 977 * (k + block.lower[2]);
    field(i, j, k) = smoothing.open_fraction()(i, j, k) > 0 ? std::fmod(n * 0.6180339887, 1.0) : 0;
  });
  return field;
}

TEST(Smoothing, conserves_the_amount_and_makes_no_new_extremes) {
  const MappingScene scene;
  Smoothing smoothing(scene.decomposition, scene.walls);
  smoothing.set_plan({.sweeps = 7, .number = Vec3::Constant(0.125)});
  cfd::Field field = random_field(scene, smoothing);
  const auto amount = [&] {
    double sum = 0;
    cfd::for_each_cell(field.size(), [&](int i, int j, int k) {
      sum += smoothing.open_fraction()(i, j, k) * field(i, j, k);
    });
    return scene.sum(sum);
  };
  const double before = amount();
  smooth(field, smoothing);
  EXPECT_NEAR(amount() / before, 1.0, 1e-14);
  cfd::for_each_cell(field.size(), [&](int i, int j, int k) {
    EXPECT_GE(field(i, j, k), 0.0);
    EXPECT_LE(field(i, j, k), 1.0);
  });
}

TEST(Smoothing, keeps_a_constant) {
  const MappingScene scene;
  Smoothing smoothing(scene.decomposition, scene.walls);
  smoothing.set_plan({.sweeps = 3, .number = Vec3::Constant(0.1)});
  cfd::Field field(scene.decomposition.block().size, 0.6);
  smooth(field, smoothing);
  cfd::for_each_cell(field.size(),
                     [&](int i, int j, int k) { EXPECT_NEAR(field(i, j, k), 0.6, 1e-15); });
}

// Variance of a point after n sweeps in an open periodic box: 2 n lambda dx^2.
TEST(Smoothing, adds_two_lambda_to_the_variance_per_sweep) {
  const MappingScene scene({15, 15, 15}, {true, true, true}, {});
  Smoothing smoothing(scene.decomposition, scene.walls);
  smoothing.set_plan({.sweeps = 3, .number = Vec3::Constant(0.11)});
  cfd::Field field(scene.decomposition.block().size);
  const cfd::Block& block = scene.decomposition.block();
  double variance = 0;
  cfd::for_each_cell(block.size, [&](int i, int j, int k) {
    const bool centre =
        i + block.lower[0] == 7 && j + block.lower[1] == 7 && k + block.lower[2] == 7;
    field(i, j, k) = centre ? 1.0 : 0.0;
  });
  smooth(field, smoothing);
  cfd::for_each_cell(block.size, [&](int i, int j, int k) {
    variance += std::pow(i + block.lower[0] - 7, 2) * field(i, j, k);
  });
  EXPECT_NEAR(scene.sum(variance), 2 * 3 * 0.11, 1e-13);
}

}  // namespace
}  // namespace gasgrain::coupling
