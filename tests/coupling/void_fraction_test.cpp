#include "coupling/void_fraction.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "cfd/loops.hpp"
#include "coupling/shared/error.hpp"
#include "mapping_fixture.hpp"

namespace gasgrain::coupling {
namespace {

TEST(SplineWeights, are_the_quadratic_b_spline) {
  for (const double offset : {-0.5, -0.2, 0.0, 0.31, 0.5}) {
    const auto w = spline_weights(offset);
    EXPECT_NEAR(w[0] + w[1] + w[2], 1.0, 1e-15);
    EXPECT_NEAR(w[2] - w[0], offset, 1e-15);                  // first moment
    EXPECT_NEAR(w[0] + w[2] - offset * offset, 0.25, 1e-15);  // variance
    for (const double weight : w) EXPECT_GE(weight, 0.0);
  }
}

TEST(SplineWeights, are_continuous_from_cell_to_cell) {
  const auto left = spline_weights(0.5), right = spline_weights(-0.5);
  EXPECT_DOUBLE_EQ(left[1], right[0]);
  EXPECT_DOUBLE_EQ(left[2], right[1]);
}

// Every test of Deposition below holds for all mappings.
class DepositionOf : public testing::TestWithParam<std::string> {
 protected:
  Mapping mapping() const { return find_mapping(GetParam()); }
};
INSTANTIATE_TEST_SUITE_P(Mappings, DepositionOf, testing::ValuesIn(mapping_names()),
                         [](const auto& of) { return of.param; });

// Larger than a cell of 0.1 m, so that a grain reaches over two cells.
constexpr double diameter = 0.27;

struct Mapped {
  std::vector<Vec3> mine;  // this rank's grains
  std::vector<std::array<double, 1>> volumes;
  cfd::Field cells;  // deposited volume per open volume
};

Mapped deposit_volumes(const MappingScene& scene, Deposition& deposition, int count) {
  Mapped result;
  int number = 0;
  for (const Vec3& x : scene.places(count)) {
    ++number;
    if (!scene.owns(x)) continue;
    result.mine.push_back(x);
    result.volumes.push_back({1e-5 * (1 + 0.3 * std::sin(number))});
  }
  deposition.locate(result.mine, std::vector<double>(result.mine.size(), diameter));
  result.cells = cfd::Field(scene.decomposition.block().size);
  deposition.deposit<1>({&result.cells}, result.volumes);
  return result;
}

TEST_P(DepositionOf, conserves_solid_volume_with_cut_cells) {
  const MappingScene scene;
  Deposition deposition(scene.decomposition, scene.walls, mapping());
  for (const double width : {0.05, 0.096, 0.3}) {  // none, three and many sweeps
    deposition.set_width(width, diameter);
    const Mapped mapped = deposit_volumes(scene, deposition, 2000);
    double given = 0, deposited = 0;
    for (const auto& volume : mapped.volumes) given += volume[0];
    cfd::for_each_cell(mapped.cells.size(), [&](int i, int j, int k) {
      deposited += deposition.open_fraction()(i, j, k) * mapped.cells(i, j, k);
      if (deposition.open_fraction()(i, j, k) == 0) {
        EXPECT_EQ(mapped.cells(i, j, k), 0.0);
      }
    });
    deposited *= scene.grid.cell_volume();
    EXPECT_NEAR(scene.sum(deposited) / scene.sum(given), 1.0, 2e-14);
  }
}

// <D x, y> = <x, D^T y> with the open volumes as weights of cells.
TEST_P(DepositionOf, gather_is_its_transpose) {
  const MappingScene scene;
  Deposition deposition(scene.decomposition, scene.walls, mapping());
  deposition.set_width(0.13, diameter);
  const Mapped mapped = deposit_volumes(scene, deposition, 500);
  cfd::Field y(scene.decomposition.block().size);
  const cfd::Block& block = scene.decomposition.block();
  double left = 0, magnitude = 0;
  cfd::for_each_cell(block.size, [&](int i, int j, int k) {
    y(i, j, k) = std::sin(1.0 + 3.1 * (i + block.lower[0]) + 1.7 * (j + block.lower[1]) +
                          0.3 * (k + block.lower[2]));
    left += deposition.open_fraction()(i, j, k) * mapped.cells(i, j, k) * y(i, j, k);
  });
  left *= scene.grid.cell_volume();
  std::vector<std::array<double, 1>> gathered(mapped.mine.size());
  deposition.gather<1>(gathered, {&y});
  double right = 0;
  for (std::size_t n = 0; n < gathered.size(); ++n) {
    right += mapped.volumes[n][0] * gathered[n][0];
    magnitude += std::abs(mapped.volumes[n][0] * gathered[n][0]);
  }
  EXPECT_NEAR(scene.sum(left), scene.sum(right), 1e-14 * scene.sum(magnitude));
}

TEST_P(DepositionOf, gathers_a_constant_exactly_next_to_walls) {
  const MappingScene scene;
  Deposition deposition(scene.decomposition, scene.walls, mapping());
  deposition.set_width(0.13, diameter);
  const Mapped mapped = deposit_volumes(scene, deposition, 500);
  cfd::Field constant(scene.decomposition.block().size, 2.5);
  std::vector<std::array<double, 1>> gathered(mapped.mine.size());
  deposition.gather<1>(gathered, {&constant});
  for (std::size_t n = 0; n < gathered.size(); ++n) {
    if (deposition.takes_part(n)) {
      EXPECT_NEAR(gathered[n][0], 2.5, 1e-13);
    }
  }
}

// Several components at once are the same as one after the other.
TEST_P(DepositionOf, components_do_not_mix) {
  const MappingScene scene;
  Deposition deposition(scene.decomposition, scene.walls, mapping());
  deposition.set_width(0.1, diameter);
  const Mapped mapped = deposit_volumes(scene, deposition, 300);
  std::vector<std::array<double, 4>> amounts;
  for (const auto& volume : mapped.volumes) {
    amounts.push_back({0.0, volume[0], 0.0, 2 * volume[0]});
  }
  std::array<cfd::Field, 4> fields;
  fields.fill(cfd::Field(scene.decomposition.block().size));
  deposition.deposit<4>({&fields[0], &fields[1], &fields[2], &fields[3]}, amounts);
  cfd::for_each_cell(mapped.cells.size(), [&](int i, int j, int k) {
    EXPECT_EQ(fields[0](i, j, k), 0.0);
    EXPECT_NEAR(fields[1](i, j, k), mapped.cells(i, j, k), 1e-14);
    EXPECT_NEAR(fields[3](i, j, k), 2 * mapped.cells(i, j, k), 1e-14);
  });
}

// Every rank maps all grains on the whole grid by itself and compares its block.
TEST_P(DepositionOf, does_not_depend_on_the_ranks) {
  for (const bool periodic : {false, true}) {
    const std::array<bool, 3> sides{periodic, periodic, false};
    const MappingScene scene({13, 9, 11}, sides);
    const MappingScene alone({13, 9, 11}, sides, {MappingScene::cylinder()}, MPI_COMM_SELF);
    Deposition shared_deposition(scene.decomposition, scene.walls, mapping());
    Deposition own_deposition(alone.decomposition, alone.walls, mapping());
    shared_deposition.set_width(0.13, diameter);
    own_deposition.set_width(0.13, diameter);
    const Mapped shared = deposit_volumes(scene, shared_deposition, 1000);
    const Mapped own = deposit_volumes(alone, own_deposition, 1000);
    const cfd::Block& block = scene.decomposition.block();
    cfd::for_each_cell(block.size, [&](int i, int j, int k) {
      EXPECT_NEAR(shared.cells(i, j, k),
                  own.cells(i + block.lower[0], j + block.lower[1], k + block.lower[2]), 1e-14);
    });
  }
}

// Grains at half the spacing of the cells, wherever their lattice lies: every cell gets as much.
TEST_P(DepositionOf, a_uniform_packing_is_uniform) {
  const MappingScene scene({8, 8, 8}, {true, true, true}, {});
  Deposition deposition(scene.decomposition, scene.walls, mapping());
  deposition.set_width(0.0, diameter);
  std::vector<Vec3> mine;
  for (int n = 0; n < 16 * 16 * 16; ++n) {
    const Vec3 x =
        scene.grid.lower + 0.05 * Vec3(n % 16 + 0.3, n / 16 % 16 + 0.8, double(n / 256) + 0.45);
    if (scene.owns(x)) mine.push_back(x);
  }
  deposition.locate(mine, std::vector<double>(mine.size(), diameter));
  cfd::Field solid(scene.decomposition.block().size);
  deposition.deposit<1>({&solid}, std::vector<std::array<double, 1>>(mine.size(), {0.5e-3 / 8}));
  cfd::for_each_cell(solid.size(),
                     [&](int i, int j, int k) { EXPECT_NEAR(solid(i, j, k), 0.5, 1e-12); });
}

// Work is limited to the box around the grains. Grains without volume in the corners of the grid
// widen it to the whole grid and must change nothing.
TEST(Deposition, cells_far_from_grains_change_nothing) {
  for (const bool periodic : {false, true}) {
    for (const double at : {0.05, 0.5, 0.95}) {  // cluster: share of the grid in each direction
      const MappingScene scene({13, 9, 11}, {periodic, false, periodic}, {});
      const Vec3 extent = scene.grid.upper - scene.grid.lower;
      std::vector<Vec3> mine;
      for (const Vec3& x : scene.places(200)) {
        const Vec3 near =
            scene.grid.lower + at * extent + 0.04 * (x - scene.grid.lower - extent / 2);
        if (scene.owns(near)) mine.push_back(near);
      }
      std::vector<std::array<double, 1>> volumes(mine.size(), {1e-5}), gathered(mine.size());
      cfd::Field cells(scene.decomposition.block().size), y(cells.size());
      for (std::size_t n = 0; n < y.count(); ++n) y[n] = std::sin(double(n));
      const auto map = [&](Deposition& deposition) {
        deposition.set_width(0.13);
        deposition.locate(mine);
        deposition.deposit<1>({&cells}, volumes);
        deposition.gather<1>(gathered, {&y});
      };
      Deposition narrow(scene.decomposition, scene.walls), wide(scene.decomposition, scene.walls);
      map(narrow);
      map(narrow);  // what the first time left in buffers must not matter
      const cfd::Field narrow_cells = cells;
      const auto narrow_gathered = gathered;
      for (int corner = 0; corner < 8; ++corner) {
        const Vec3 share(corner % 2, corner / 2 % 2, double(corner / 4));
        const Vec3 x = scene.grid.lower + Vec3(0.01, 0.01, 0.01) +
                       share.cwiseProduct(extent - Vec3(0.02, 0.02, 0.02));
        if (!scene.owns(x)) continue;
        mine.push_back(x);
        volumes.push_back({0.0});
      }
      gathered.resize(mine.size());
      map(wide);
      cfd::for_each_cell(cells.size(), [&](int i, int j, int k) {
        EXPECT_EQ(cells(i, j, k), narrow_cells(i, j, k));
      });
      for (std::size_t n = 0; n < narrow_gathered.size(); ++n)
        EXPECT_EQ(gathered[n][0], narrow_gathered[n][0]);
    }
  }
}

TEST(Deposition, refuses_a_grain_that_reaches_beyond_the_next_block) {
  const MappingScene scene({4, 1, 4}, {false, true, false}, {});
  Deposition deposition(scene.decomposition, scene.walls, Mapping::exact);
  deposition.set_width(0.0, 0.15);
  EXPECT_THROW(deposition.set_width(0.0, 0.25), UserError);
}

TEST(Deposition, refuses_a_grain_of_another_rank) {
  const MappingScene scene;
  Deposition deposition(scene.decomposition, scene.walls);
  const std::vector<Vec3> outside{scene.grid.lower - Vec3(1, 1, 1)};
  EXPECT_THROW(deposition.locate(outside), InternalError);
}

}  // namespace
}  // namespace gasgrain::coupling
