// Several values per cell side by side, and the exchange of their ghosts between blocks.
#pragma once

#include <array>
#include <vector>

#include "cfd/field.hpp"
#include "cfd/grid.hpp"

namespace gasgrain::coupling {

// Indexed as cfd::Field is. All components of a cell are adjacent, so that a grain touches 27
// places rather than 27 per component, a sweep reads its coefficients once for all components, and
// the compiler can use vector instructions across components.
template <int components>
using CellArray = std::vector<std::array<double, components>>;

// The number of values that a CellArray of this block needs.
inline std::size_t cell_array_size(const cfd::Decomposition& decomposition) {
  return cfd::Field(decomposition.block().size).count();
}

// All functions are collective over neighbours, move one layer of ghosts with all components in one
// message, and leave ghosts at non-periodic sides of the grid as they are.

// Ghosts across block faces, without edges and corners: what a seven-point stencil reads.
template <int components>
void fill_face_ghosts(const cfd::Decomposition& decomposition, CellArray<components>& cells);

// Ghosts with edges and corners: what 27 cells around an owned one read.
template <int components>
void fill_ghosts(const cfd::Decomposition& decomposition, CellArray<components>& cells);

// Transpose of fill_ghosts: adds every ghost to the cell it is a copy of and zeroes it. The order
// of additions is fixed, so results repeat bit for bit.
template <int components>
void add_ghosts_to_owners(const cfd::Decomposition& decomposition, CellArray<components>& cells);

}  // namespace gasgrain::coupling
