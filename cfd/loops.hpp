// Loops over the owned cells and faces of a block, x fastest.
#pragma once

#include <algorithm>

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

// visit(storage index) for every index of one row; as in for_box.
template <class Visit>
void for_row(std::ptrdiff_t first, int length, const Visit& visit) {
#pragma omp simd
  for (std::ptrdiff_t n = first; n < first + length; ++n) visit(n);
}

// visit(storage index) for every index of the box. The visits must not depend on each other: rows
// are vectorized. Lambdas that capture raw pointers by value run fastest.
template <class Visit>
void for_box(const IndexBox& box, const Field& like, const Visit& visit) {
  for_each_row(box, like,
               [&visit](std::ptrdiff_t first, int length) { for_row(first, length, visit); });
}

// visit(part) for parts of the box that are some rows thick: fields of one part stay in the fastest
// cache from one sweep over it to the next.
template <class Visit>
void for_each_part(const IndexBox& box, const Visit& visit) {
  constexpr int enough = 500;  // indices
  const int row = std::max(box.end[0] - box.begin[0], 1);
  const int rows = std::max(box.end[1] - box.begin[1], 1);
  const int thick_y = std::min((enough + row - 1) / row, rows);
  const int thick_z = thick_y < rows ? 1 : std::max(enough / (row * rows), 1);
  IndexBox part = box;
  for (int k = box.begin[2]; k < box.end[2]; k += thick_z) {
    part.begin[2] = k;
    part.end[2] = std::min(k + thick_z, box.end[2]);
    for (int j = box.begin[1]; j < box.end[1]; j += thick_y) {
      part.begin[1] = j;
      part.end[1] = std::min(j + thick_y, box.end[1]);
      visit(part);
    }
  }
}

inline IndexBox intersection(const IndexBox& a, const IndexBox& b) {
  IndexBox common;
  for (int d = 0; d < 3; ++d) {
    common.begin[d] = std::max(a.begin[d], b.begin[d]);
    common.end[d] = std::min(a.end[d], b.end[d]);
  }
  return common;
}

// Sum of term(storage index) over one row, vectorized, in an order that depends on the build and
// the length only. Terms as in for_box. Several sums of the same fields cost one reading of them
// when they are taken row by row.
template <class Term>
double sum_row(std::ptrdiff_t first, int length, const Term& term) {
  double sum = 0.0;
#pragma omp simd reduction(+ : sum)
  for (std::ptrdiff_t n = first; n < first + length; ++n) sum += term(n);
  return sum;
}

// Sum over the box, row by row.
template <class Term>
double sum_box(const IndexBox& box, const Field& like, const Term& term) {
  double sum = 0.0;
  for_each_row(box, like,
               [&](std::ptrdiff_t first, int length) { sum += sum_row(first, length, term); });
  return sum;
}

// Largest term(storage index), at least 0, over one row. Terms as in for_box; none may be NaN.
template <class Term>
double max_row(std::ptrdiff_t first, int length, const Term& term) {
  double largest = 0.0;
#pragma omp simd reduction(max : largest)
  for (std::ptrdiff_t n = first; n < first + length; ++n) {
    const double value = term(n);
    largest = value > largest ? value : largest;
  }
  return largest;
}

// The same over the box.
template <class Term>
double max_box(const IndexBox& box, const Field& like, const Term& term) {
  double largest = 0.0;
  for_each_row(box, like, [&](std::ptrdiff_t first, int length) {
    const double row = max_row(first, length, term);
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
