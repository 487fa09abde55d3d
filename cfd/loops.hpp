// Loops over the owned cells and faces of a block, x fastest.
#pragma once

#include "cfd/field.hpp"
#include "cfd/grid.hpp"

namespace gasgrain::cfd {

// visit(i, j, k) for every owned cell.
template <class Visit>
void for_each_cell(const Index3& size, Visit&& visit) {
  for (int k = 0; k < size[2]; ++k) {
    for (int j = 0; j < size[1]; ++j) {
      for (int i = 0; i < size[0]; ++i) visit(i, j, k);
    }
  }
}

// Half-open box of local indices.
struct IndexBox {
  Index3 begin, end;
};

// visit(first storage index, length) for every row of a box along x.
template <class Visit>
void for_each_row(const IndexBox& box, const Field& like, Visit&& visit) {
  const int length = box.end[0] - box.begin[0];
  if (length <= 0) return;
  for (int k = box.begin[2]; k < box.end[2]; ++k) {
    for (int j = box.begin[1]; j < box.end[1]; ++j) {
      visit(like.index(box.begin[0], j, k), length);
    }
  }
}

// visit(storage index) for every index of the box. The visits must not depend on each other: rows
// are vectorized. Lambdas that capture raw pointers by value run fastest.
template <class Visit>
void for_box(const IndexBox& box, const Field& like, const Visit& visit) {
  for_each_row(box, like, [&visit](std::ptrdiff_t first, int length) {
#pragma omp simd
    for (std::ptrdiff_t n = first; n < first + length; ++n) visit(n);
  });
}

// Sum of term(storage index) over the box; row sums are vectorized, in an order that depends on the
// build and the box only. Terms as in for_box.
template <class Term>
double sum_box(const IndexBox& box, const Field& like, const Term& term) {
  double sum = 0.0;
  for_each_row(box, like, [&](std::ptrdiff_t first, int length) {
    double row = 0.0;
#pragma omp simd reduction(+ : row)
    for (std::ptrdiff_t n = first; n < first + length; ++n) row += term(n);
    sum += row;
  });
  return sum;
}

// Largest term(storage index), at least 0, over the box. Terms as in for_box; none may be NaN.
template <class Term>
double max_box(const IndexBox& box, const Field& like, const Term& term) {
  double largest = 0.0;
  for_each_row(box, like, [&](std::ptrdiff_t first, int length) {
    double row = 0.0;
#pragma omp simd reduction(max : row)
    for (std::ptrdiff_t n = first; n < first + length; ++n) {
      const double value = term(n);
      row = value > row ? value : row;
    }
    largest = row > largest ? row : largest;
  });
  return largest;
}

// The same over the owned cells of a cell field.
template <class Visit>
void for_cells(const Field& like, const Visit& visit) {
  for_box({{0, 0, 0}, like.size()}, like, visit);
}

template <class Term>
double max_cells(const Field& like, const Term& term) {
  return max_box({{0, 0, 0}, like.size()}, like, term);
}

template <class Term>
double sum_cells(const Field& like, const Term& term) {
  return sum_box({{0, 0, 0}, like.size()}, like, term);
}

// Number of owned faces per direction: one per cell, and one more where the block touches the upper
// side of the grid.
inline Index3 owned_faces(const Decomposition& decomposition, int direction) {
  Index3 size = decomposition.block().size;
  size[direction] += decomposition.at_boundary(direction, 1) ? 1 : 0;
  return size;
}

// visit(i, j, k) for every owned face of the direction.
template <class Visit>
void for_each_face(const Decomposition& decomposition, int direction, Visit&& visit) {
  for_each_cell(owned_faces(decomposition, direction), visit);
}

}  // namespace gasgrain::cfd
