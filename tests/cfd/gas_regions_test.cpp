#include <gtest/gtest.h>

#include "cfd/gas_regions.hpp"
#include "cfd/halo_exchange.hpp"
#include "cfd/loops.hpp"

namespace gasgrain::cfd {
namespace {

// A spiral-free check by hand: two chambers joined only around the far end of a wall at x = 4.
struct Chambers {
  Decomposition blocks;
  VectorField joined;
  Field outlet;
};

Chambers chambers(bool gap) {
  Grid grid;
  grid.cells = {8, 1, 9};
  Chambers c{Decomposition(MPI_COMM_WORLD, grid, {false, false, false}), {}, {}};
  const Block& block = c.blocks.block();
  for (Field& field : c.joined) field = Field(block.size);
  c.outlet = Field(block.size);
  for_each_cell(block.size, [&](int i, int j, int k) {
    const int x = i + block.lower[0], z = k + block.lower[2];
    c.joined[0](i, j, k) = x > 0 && (x != 4 || (gap && z == 8)) ? 1.0 : 0.0;
    c.joined[2](i, j, k) = z > 0 ? 1.0 : 0.0;
    if (x == 7 && z == 0) c.outlet(i, j, k) = 1.0;
  });
  fill_ghosts(c.blocks, c.joined);
  return c;
}

TEST(GasRegions, chambers_behind_a_wall_are_two_and_only_one_has_the_outlet) {
  const Chambers c = chambers(false);
  const GasRegions found = find_gas_regions(c.blocks, c.joined, c.outlet);
  ASSERT_EQ(found.regions.size(), 2U);
  EXPECT_FALSE(found.regions[0].has_outlet);
  EXPECT_TRUE(found.regions[1].has_outlet);
  EXPECT_EQ(found.regions[0].first_cell, (Index3{0, 0, 0}));
  EXPECT_EQ(found.regions[1].first_cell, (Index3{4, 0, 0}));
  EXPECT_EQ(found.regions[0].cells, 36.0);
  EXPECT_EQ(found.regions[1].cells, 36.0);
  EXPECT_TRUE(found.any_singular());
}

TEST(GasRegions, a_gap_on_another_rank_joins_them) {
  const Chambers c = chambers(true);
  const GasRegions found = find_gas_regions(c.blocks, c.joined, c.outlet);
  ASSERT_EQ(found.regions.size(), 1U);
  EXPECT_EQ(found.regions[0].cells, 72.0);
  EXPECT_FALSE(found.any_singular());
}

TEST(GasRegions, cells_without_joined_faces_belong_to_none) {
  Chambers c = chambers(true);
  for (Field& field : c.joined) field.fill(0.0);
  const GasRegions found = find_gas_regions(c.blocks, c.joined, c.outlet);
  ASSERT_EQ(found.regions.size(), 1U);  // the cell at the outlet
  EXPECT_EQ(found.regions[0].cells, 1.0);
}

TEST(GasRegions, sums_per_region_cover_all_ranks) {
  const Chambers c = chambers(false);
  const GasRegions found = find_gas_regions(c.blocks, c.joined, c.outlet);
  const Field ones(c.blocks.block().size, 2.0);
  EXPECT_EQ(sum_per_region(c.blocks, found, ones), (std::vector<double>{72.0, 72.0}));
}

}  // namespace
}  // namespace gasgrain::cfd
