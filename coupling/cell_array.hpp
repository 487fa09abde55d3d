// Several values per cell side by side, and the exchange of their ghosts between blocks.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <vector>

#include "cfd/field.hpp"
#include "cfd/grid.hpp"
#include "cfd/loops.hpp"

namespace gasgrain::coupling {

// Indexed as cfd::Field is. All components of a cell are adjacent, so that a grain touches 27
// places rather than 27 per component, a sweep reads its coefficients once for all components, and
// the compiler can use vector instructions across components.
// Padded to a power of two, so that no cell straddles lines of the cache that it need not.
template <int components>
inline constexpr int stored_components =
    static_cast<int>(std::bit_ceil(static_cast<unsigned>(components)));
template <int components>
struct alignas(stored_components<components> * sizeof(double)) CellValues
    : std::array<double, stored_components<components>> {};
template <int components>
using CellArray = std::vector<CellValues<components>>;

// Ghost layers around the block: how many an array has, and how many of them a message moves. The
// default is the layout of cfd::Field with the layer that 27 cells around an owned one need.
struct GhostLayers {
  int stored = cfd::halo;
  int moved = 1;  // <= stored, and <= the cells of any block in a direction with neighbours
};

// Index of the local cell (i, j, k) is (i + stored) + (j + stored) y + (k + stored) z.
struct CellStrides {
  std::ptrdiff_t y, z;

  CellStrides(const cfd::Index3& size, const GhostLayers& ghosts)
      : y(size[0] + 2 * ghosts.stored + 1), z(y * (size[1] + 2 * ghosts.stored + 1)) {}
};

// The number of values that a CellArray of this block needs.
std::size_t cell_array_size(const cfd::Decomposition& decomposition,
                            const GhostLayers& ghosts = {});

// Zeroes the cells of `box`, ghosts included; `like` is any field of the block.
template <int components>
void clear(CellArray<components>& cells, const cfd::IndexBox& box, const cfd::Field& like) {
  cfd::for_each_row(box, like, [&](std::ptrdiff_t first, int length) {
    std::fill_n(cells.begin() + first, length, CellValues<components>{});
  });
}

// The functions below are collective over neighbours, move layers of ghosts with all components in
// one message, and leave ghosts at non-periodic sides of the grid as they are.

// Ghosts across block faces, without edges and corners: what a seven-point stencil reads.
template <int components>
void fill_face_ghosts(const cfd::Decomposition& decomposition, CellArray<components>& cells);

// Ghosts with edges and corners: what 27 cells around an owned one read.
template <int components>
void fill_ghosts(const cfd::Decomposition& decomposition, CellArray<components>& cells,
                 const GhostLayers& ghosts = {});

// Transpose of fill_ghosts: adds every ghost to the cell it is a copy of and zeroes it. The order
// of additions is fixed, so results repeat bit for bit.
template <int components>
void add_ghosts_to_owners(const cfd::Decomposition& decomposition, CellArray<components>& cells,
                          const GhostLayers& ghosts = {});

}  // namespace gasgrain::coupling

// instantiate(n) for every number of components that arrays have.
#define GASGRAIN_FOR_COMPONENTS(instantiate) \
  instantiate(1) instantiate(2) instantiate(3) instantiate(4) instantiate(6)
