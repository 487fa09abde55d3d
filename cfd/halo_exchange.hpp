// Copies of neighbours' values in ghost layers, and the transpose of that copy.
#pragma once

#include <span>

#include "cfd/field.hpp"
#include "cfd/grid.hpp"

namespace gasgrain::cfd {

// Collective; all ghosts including edges and corners. Ghosts at a non-periodic side of the grid are
// left as they are. Works for cell fields and for face fields (a face belongs to the cell above it;
// the face at index `size` is a ghost unless the block touches the upper side of the grid).
void fill_ghosts(const Decomposition& decomposition, Field& field);
void fill_ghosts(const Decomposition& decomposition, VectorField& field);
void fill_ghosts(const Decomposition& decomposition, std::span<Field* const> fields);  // together

// Transpose of fill_ghosts for cell fields: adds every ghost to the cell it is a copy of, then
// zeroes the ghost. Order of additions is fixed, so results repeat bit for bit.
void add_ghosts_to_owners(const Decomposition& decomposition, Field& field);

// Sums over all ranks in a fixed order.
double sum_over_ranks(const Decomposition& decomposition, double value);
void sum_over_ranks(const Decomposition& decomposition, std::span<double> values);  // each value
double max_over_ranks(const Decomposition& decomposition, double value);

}  // namespace gasgrain::cfd
