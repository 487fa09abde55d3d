// One level of the multigrid of multigrid.cpp: coefficients, unknowns and smoother of this rank's
// block, in single precision.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "cfd/grid.hpp"

namespace gasgrain::cfd {

struct MultigridLevel {
  Index3 size{};                             // owned cells
  std::array<int, 3> coarsening{1, 1, 1};    // cells joined per direction on the next level
  int parity = 0;                            // of the global index of owned cell (0,0,0)
  std::array<std::ptrdiff_t, 3> stride{};    // one ghost layer all around, x fastest
  std::array<std::vector<double>, 3> width;  // cell widths incl. one ghost at each end, m
  std::array<std::vector<float>, 3> face;    // coefficient of the lower face of each cell
  std::vector<float> outlet;                 // extra diagonal
  std::vector<float> inverse_diagonal;       // 0 for a cell without coefficients
  std::vector<float> x, b;
  std::vector<float> send, receive;  // packed block faces

  void allocate(const Index3& n);
  std::ptrdiff_t at(int i, int j, int k) const {
    return (i + 1) + (j + 1) * stride[1] + (k + 1) * stride[2];
  }
  long cells() const { return long(size[0]) * size[1] * size[2]; }

  // Face ghosts of x; the stencil needs no edges or corners. Collective.
  void fill_ghosts(const Decomposition& blocks);
  void set_inverse_diagonal();
  // One Gauss-Seidel sweep over the cells of one colour.
  void smooth(int colour);
  // The first sweep when x = 0: the other colour is zero, ghosts too.
  void smooth_from_zero(int colour);
  // Coefficients of `coarse`, whose cells are joined ones of this level (multigrid.cpp).
  void coarsen_coefficients(MultigridLevel& coarse) const;
};

}  // namespace gasgrain::cfd
