// The uniform Cartesian grid of the gas and its blocks on the ranks.
#pragma once

#include <mpi.h>

#include <array>

#include "coupling/shared/vec3.hpp"

namespace gasgrain::cfd {

using Index3 = std::array<int, 3>;

// The whole grid; cell (i,j,k) spans lower + spacing * [i,i+1] x [j,j+1] x [k,k+1].
struct Grid {
  Vec3 lower = Vec3::Zero();  // m
  Vec3 upper = Vec3::Ones();  // m
  Index3 cells{1, 1, 1};

  Vec3 spacing() const {  // m
    return (upper - lower).cwiseQuotient(Vec3(cells[0], cells[1], cells[2]));
  }
  double cell_volume() const { return spacing().prod(); }  // m^3
  // Global index of the cell that holds x; outside the grid it is out of range.
  Index3 cell_of(const Vec3& x) const;
};

// The cells of one rank: global indices [lower, lower + size).
struct Block {
  Index3 lower{0, 0, 0};
  Index3 size{0, 0, 0};
};

// How the grid is cut into blocks: `ranks` parts per direction. Long directions are cut at
// multiples of 2 to 16 layers where that makes no part more than 3 % longer than the mean; others
// as evenly as possible (parts may differ by one layer). Every rank owns a non-empty block.
class Decomposition {
 public:
  // Chooses the parts with the least block surface, unless `ranks` (all > 0) prescribes them.
  // Collective. Throws UserError when a direction has more parts than layers or the product of
  // `ranks` is not the size of `communicator`.
  Decomposition(MPI_Comm communicator, const Grid& grid, const std::array<bool, 3>& periodic,
                const Index3& ranks = {0, 0, 0});

  MPI_Comm communicator() const { return communicator_; }
  int rank() const { return rank_; }
  int size() const { return ranks_[0] * ranks_[1] * ranks_[2]; }
  const Grid& grid() const { return grid_; }
  const Block& block() const { return block_; }
  const Index3& ranks() const { return ranks_; }
  const std::array<bool, 3>& periodic() const { return periodic_; }

  // Rank that owns the global cell (in range).
  int owner(const Index3& cell) const;
  // Neighbour rank across the lower (side 0) or upper (side 1) block face, or MPI_PROC_NULL.
  int neighbour(int direction, int side) const { return neighbours_[direction][side]; }
  // True when this block touches that side of the grid and the direction is not periodic.
  bool at_boundary(int direction, int side) const {
    return neighbours_[direction][side] == MPI_PROC_NULL;
  }

 private:
  MPI_Comm communicator_;
  int rank_ = 0;
  Grid grid_;
  std::array<bool, 3> periodic_;
  Index3 ranks_;
  Index3 unit_{1, 1, 1};  // layers that are not cut
  Block block_;
  std::array<std::array<int, 2>, 3> neighbours_;
};

}  // namespace gasgrain::cfd
