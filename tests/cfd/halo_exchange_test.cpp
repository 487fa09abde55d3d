#include <gtest/gtest.h>

#include "cfd/halo_exchange.hpp"
#include "cfd/loops.hpp"

namespace gasgrain::cfd {
namespace {

struct Case {
  Index3 cells;
  std::array<bool, 3> periodic;
};

// Blocks of every thickness down to one layer, with and without periodic directions.
const Case cases[] = {{{6, 5, 9}, {false, false, false}},
                      {{6, 5, 9}, {true, true, true}},
                      {{1, 4, 4}, {true, false, true}},
                      {{4, 1, 1}, {false, true, true}},
                      {{1, 1, 5}, {false, false, true}}};

int wrapped(int index, int cells) {
  return ((index % cells) + cells) % cells;
}

double number(const Index3& cell) {
  return 1.0 + cell[0] + 100.0 * cell[1] + 10000.0 * cell[2];
}

class HaloExchange : public ::testing::TestWithParam<Case> {
 protected:
  HaloExchange() : blocks(MPI_COMM_WORLD, grid(), GetParam().periodic) {}
  static Grid grid() {
    Grid result;
    result.cells = GetParam().cells;
    return result;
  }
  // Global cell that a local index stands for; false when outside a non-periodic side.
  bool global(Index3 local, Index3& cell) const {
    for (int d = 0; d < 3; ++d) {
      cell[d] = local[d] + blocks.block().lower[d];
      const int cells = GetParam().cells[d];
      if (GetParam().periodic[d]) {
        cell[d] = wrapped(cell[d], cells);
      } else if (cell[d] < 0 || cell[d] >= cells) {
        return false;
      }
    }
    return true;
  }
  template <class Visit>
  void for_each_stored_cell(Visit visit) const {
    const Index3& n = blocks.block().size;
    for (int k = -halo; k < n[2] + halo; ++k) {
      for (int j = -halo; j < n[1] + halo; ++j) {
        for (int i = -halo; i < n[0] + halo; ++i) visit(i, j, k);
      }
    }
  }
  Decomposition blocks;
};

TEST_P(HaloExchange, ghosts_hold_the_values_of_the_cells_they_copy) {
  Field field(blocks.block().size, -1.0);
  for_each_cell(field.size(), [&](int i, int j, int k) {
    Index3 cell;
    if (global({i, j, k}, cell)) field(i, j, k) = number(cell);
  });
  fill_ghosts(blocks, field);
  for_each_stored_cell([&](int i, int j, int k) {
    Index3 cell;
    const double expected = global({i, j, k}, cell) ? number(cell) : -1.0;
    EXPECT_EQ(field(i, j, k), expected) << i << " " << j << " " << k;
  });
}

TEST_P(HaloExchange, upper_ghost_faces_come_from_the_block_above) {
  Field field(blocks.block().size, -1.0);
  for_each_cell(field.size(), [&](int i, int j, int k) {
    Index3 cell;
    if (global({i, j, k}, cell)) field(i, j, k) = number(cell);
  });
  fill_ghosts(blocks, field);
  for (int d = 0; d < 3; ++d) {
    if (blocks.at_boundary(d, 1)) continue;
    Index3 local{0, 0, 0}, cell;
    local[d] = blocks.block().size[d] + halo;  // the last face a staggered field stores
    const double expected = global(local, cell) ? number(cell) : -1.0;
    EXPECT_EQ(field(local[0], local[1], local[2]), expected);
  }
}

TEST_P(HaloExchange, adding_ghosts_is_the_transpose_of_filling_them) {
  // <fill x, y> = <x, add y> for arbitrary x on cells and y on cells and ghosts
  Field x(blocks.block().size), y(blocks.block().size);
  double seed = 0.1 + blocks.rank();
  const auto next = [&] { return seed = 3.9 * seed - std::floor(3.9 * seed); };
  for_each_cell(x.size(), [&](int i, int j, int k) { x(i, j, k) = next(); });
  for_each_stored_cell([&](int i, int j, int k) {
    Index3 cell;
    if (global({i, j, k}, cell)) y(i, j, k) = next();
  });
  Field filled = x;
  fill_ghosts(blocks, filled);
  double left = 0.0, right = 0.0, ghosts = 0.0;
  for_each_stored_cell([&](int i, int j, int k) { left += filled(i, j, k) * y(i, j, k); });
  add_ghosts_to_owners(blocks, y);
  for_each_stored_cell([&](int i, int j, int k) { ghosts += y(i, j, k); });
  for_each_cell(x.size(), [&](int i, int j, int k) {
    right += x(i, j, k) * y(i, j, k);
    ghosts -= y(i, j, k);
  });
  left = sum_over_ranks(blocks, left);
  EXPECT_NEAR(left, sum_over_ranks(blocks, right), 1e-13 * left);
  EXPECT_NEAR(ghosts, 0.0, 1e-10);
}

INSTANTIATE_TEST_SUITE_P(Grids, HaloExchange, ::testing::ValuesIn(cases));

TEST(Sums, over_ranks_add_each_value) {
  Grid grid;
  grid.cells = {4, 4, 4};
  const Decomposition blocks(MPI_COMM_WORLD, grid, {false, false, false});
  std::vector<double> values{1.0, double(blocks.rank())};
  sum_over_ranks(blocks, values);
  const double n = blocks.size();
  EXPECT_EQ(values[0], n);
  EXPECT_EQ(values[1], n * (n - 1) / 2);
  EXPECT_EQ(max_over_ranks(blocks, blocks.rank()), n - 1);
}

}  // namespace
}  // namespace gasgrain::cfd
