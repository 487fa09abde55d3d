#include <gtest/gtest.h>

#include <algorithm>

#include "cfd/grid.hpp"
#include "cfd/halo_exchange.hpp"
#include "cfd/loops.hpp"
#include "coupling/shared/error.hpp"

namespace gasgrain::cfd {
namespace {

Grid grid_of(const Index3& cells) {
  Grid grid;
  grid.cells = cells;
  return grid;
}

TEST(Grid, cell_of_finds_the_cell_of_a_point_and_leaves_the_range_outside) {
  Grid grid = grid_of({4, 5, 6});
  grid.lower = Vec3(-1, 0, 0);
  grid.upper = Vec3(1, 5, 12);
  EXPECT_EQ(grid.cell_of({-0.9, 0.5, 11.0}), (Index3{0, 0, 5}));
  EXPECT_EQ(grid.cell_of({0.0, 4.99, 2.0}), (Index3{2, 4, 1}));
  EXPECT_EQ(grid.cell_of({-1.2, 5.5, 12.5}), (Index3{-1, 5, 6}));
}

TEST(Decomposition, blocks_tile_the_grid_and_owner_names_the_block) {
  for (const Index3& cells :
       {Index3{7, 5, 11}, Index3{40, 8, 160}, Index3{1, 1, 9}, Index3{5, 3, 436}}) {
    const Decomposition blocks(MPI_COMM_WORLD, grid_of(cells), {false, true, false});
    double owned = 0.0, misplaced = 0.0;
    const Block& block = blocks.block();
    for_each_cell(block.size, [&](int i, int j, int k) {
      const Index3 cell{i + block.lower[0], j + block.lower[1], k + block.lower[2]};
      owned += 1.0;
      if (blocks.owner(cell) != blocks.rank()) misplaced += 1.0;
    });
    EXPECT_EQ(misplaced, 0.0);
    EXPECT_EQ(sum_over_ranks(blocks, owned), double(cells[0]) * cells[1] * cells[2]);
  }
}

TEST(Decomposition, parts_of_a_direction_differ_by_one_layer_at_most) {
  const Decomposition blocks(MPI_COMM_WORLD, grid_of({7, 1, 11}), {false, false, false});
  for (int d = 0; d < 3; ++d) {
    const double size = blocks.block().size[d];
    const double largest = max_over_ranks(blocks, size), smallest = -max_over_ranks(blocks, -size);
    EXPECT_LE(largest - smallest, 1.0);
  }
}

// Coarse cells of 4 layers end at the borders, and no rank has much more to do than the others.
TEST(Decomposition, long_directions_are_cut_where_coarse_cells_end) {
  const Decomposition blocks(MPI_COMM_WORLD, grid_of({5, 3, 436}), {false, false, false});
  EXPECT_EQ(blocks.block().lower[2] % 4, 0);
  EXPECT_LE(blocks.block().size[2] * blocks.ranks()[2], 1.03 * 436);
}

TEST(Decomposition, cuts_the_longest_direction) {
  const Decomposition blocks(MPI_COMM_WORLD, grid_of({40, 8, 160}), {false, false, false});
  EXPECT_EQ(blocks.ranks()[2], blocks.size());
}

TEST(Decomposition, more_ranks_than_layers_is_a_user_error) {
  if (Decomposition(MPI_COMM_SELF, grid_of({1, 1, 1}), {false, false, false}).size() != 1) FAIL();
  int ranks = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  if (ranks == 1) return;
  EXPECT_THROW(Decomposition(MPI_COMM_WORLD, grid_of({1, 1, 1}), {false, false, false}), UserError);
  EXPECT_THROW(
      Decomposition(MPI_COMM_WORLD, grid_of({1, 8, 8}), {false, false, false}, {ranks, 1, 1}),
      UserError);
}

TEST(Decomposition, prescribed_ranks_must_match_the_communicator) {
  int ranks = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  EXPECT_THROW(
      Decomposition(MPI_COMM_WORLD, grid_of({8, 8, 8}), {false, false, false}, {ranks + 1, 1, 1}),
      UserError);
  const Decomposition blocks(MPI_COMM_WORLD, grid_of({8, 8, 8}), {false, false, false},
                             {1, ranks, 1});
  EXPECT_EQ(blocks.ranks()[1], ranks);
}

}  // namespace
}  // namespace gasgrain::cfd
