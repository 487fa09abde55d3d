#include "coupling/mapping.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>

#include "coupling/shared/error.hpp"
#include "coupling_scene.hpp"
#include "tests/gas_case_text.hpp"

namespace gasgrain::coupling {
namespace {

std::vector<CellShare> shares_at(Mapping mapping, const Vec3& offset, double radius) {
  std::vector<CellShare> shares;
  share_among_cells(shares, mapping, offset, Vec3::Constant(radius));
  return shares;
}

std::vector<Vec3> offsets(int count) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-0.5, 0.5);
  std::vector<Vec3> result;
  for (int n = 0; n < count; ++n) {
    const double x = place(random), y = place(random), z = place(random);
    result.emplace_back(x, y, z);
  }
  return result;
}

Vec3 cell_centre(const CellShare& share) {
  return {double(share.offset[0]), double(share.offset[1]), double(share.offset[2])};
}

class MappingOf : public testing::TestWithParam<std::string> {
 protected:
  Mapping mapping() const { return find_mapping(GetParam()); }
};
INSTANTIATE_TEST_SUITE_P(Mappings, MappingOf, testing::ValuesIn(mapping_names()),
                         [](const auto& of) { return of.param; });

const cfd::Grid unit_grid{
    .lower = Vec3::Zero(), .upper = Vec3::Constant(10), .cells = {10, 10, 10}};

TEST_P(MappingOf, shares_add_up_to_one_within_the_reach) {
  for (const double radius : {0.2, 0.5, 1.0, 1.7}) {
    for (const Vec3& offset : offsets(50)) {
      double sum = 0;
      for (const CellShare& share : shares_at(mapping(), offset, radius)) {
        sum += share.share;
        for (int d = 0; d < 3; ++d)
          EXPECT_LE(std::abs(share.offset[d]), mapping_reach(mapping(), unit_grid, 2 * radius));
      }
      EXPECT_NEAR(sum, 1.0, 1e-12);
    }
  }
}

TEST_P(MappingOf, has_the_variance_that_smoothing_counts_on) {
  constexpr int count = 20000;
  const double radius = 0.8;
  Vec3 variance = Vec3::Zero();
  for (const Vec3& offset : offsets(count)) {
    for (const CellShare& share : shares_at(mapping(), offset, radius))
      variance += share.share / count * (cell_centre(share) - offset).cwiseAbs2();
  }
  const Vec3 expected = mapping_variance(mapping(), unit_grid, 2 * radius);
  EXPECT_LT((variance - expected).cwiseAbs().maxCoeff(), 0.02 * expected[0]);
}

// Largest change of a cell's share when the grain moves by `way` spacings, over `way`.
double steepest_change(Mapping mapping, double way) {
  double steepest = 0;
  for (const Vec3& offset : offsets(4000)) {
    if (offset[0] > 0.5 - way) continue;
    std::map<cfd::Index3, double> change;
    for (const CellShare& s : shares_at(mapping, offset, 0.4)) change[s.offset] -= s.share;
    for (const CellShare& s : shares_at(mapping, offset + Vec3(way, 0, 0), 0.4))
      change[s.offset] += s.share;
    for (const auto& [cell, value] : change) steepest = std::max(steepest, std::abs(value) / way);
  }
  return steepest;
}

// Why the spline is the default: satellites jump however small the way (the centroid between
// cells, not within one).
TEST(Mapping, continuous_ones_have_a_bounded_slope) {
  for (const Mapping mapping : {Mapping::spline, Mapping::trilinear, Mapping::exact})
    EXPECT_LT(steepest_change(mapping, 1e-4), 2.0) << mapping_name(mapping);
  EXPECT_GT(steepest_change(Mapping::satellite, 1e-3), 30.0);
}

TEST(Mapping, spline_and_trilinear_keep_the_centre_of_mass) {
  for (const Mapping mapping : {Mapping::spline, Mapping::trilinear}) {
    for (const Vec3& offset : offsets(50)) {
      Vec3 centre = Vec3::Zero();
      for (const CellShare& share : shares_at(mapping, offset, 0.4))
        centre += share.share * cell_centre(share);
      EXPECT_LT((centre - offset).norm(), 1e-14);
    }
  }
}

TEST(Mapping, is_an_option_of_the_case) {
  const std::string gas =
      GasCaseText{.upper = Vec3::Ones(), .cells = {4, 4, 4}}.text() + "[coupling]\n";
  EXPECT_EQ(CoupledCase(gas).options.mapping, Mapping::spline);
  EXPECT_EQ(CoupledCase(gas + "mapping = \"exact\"").options.mapping, Mapping::exact);
  EXPECT_THROW(CoupledCase(gas + "mapping = \"nearest\""), UserError);
}

}  // namespace
}  // namespace gasgrain::coupling
