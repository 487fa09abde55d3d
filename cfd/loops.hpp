// Loops over the owned cells and faces of a block, x fastest.
#pragma once

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
