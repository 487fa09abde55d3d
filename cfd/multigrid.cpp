// Multigrid for -div(c grad p) + d p with strongly varying c, closed faces and thin domains.
//
// - Coarsening by 2 in the directions whose spacing is still small (semi-coarsening), so that the
//   strong couplings are coarsened first. Cells are joined within a rank's block, hence blocks of
//   any (odd, uneven) size work and a coarse face never straddles two ranks.
// - Transfer: piecewise constant, its transpose downwards. The coarse face coefficient is the sum
//   of the fine ones times the ratio of the distances between cell centres, which makes up for the
//   constant transfer (Braess, Computing 55 (1995) 379, over-correction; Wesseling 1992, ch. 5).
// - Smoother: red-black Gauss-Seidel, two sweeps down and two up in mirrored order, which keeps the
//   cycle symmetric. Colours follow the global index, so they agree across ranks.
// - Coarsest level: gathered on every rank, dense Cholesky. A pure Neumann problem gets a relative
//   1e-6 on the diagonal there; the constant it adds lies in the null space.
// - Single precision: the cycle only preconditions a conjugate-gradient iteration in double.
#include "cfd/multigrid.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "cfd/multigrid_level.hpp"

namespace gasgrain::cfd {

namespace {

using Level = MultigridLevel;

constexpr long coarsest_cells = 96;
constexpr double still_small = 1.9;  // coarsen while spacing < 1.9 x the smallest one
constexpr int sweeps = 2;

}  // namespace

struct Multigrid::Coarsest {
  std::vector<int> counts, offsets;                // cells per rank
  std::vector<int> matrix_counts, matrix_offsets;  // entries per rank: its columns
  std::vector<float> number;                       // of every cell, ghosts filled; -1 outside
  int total = 0;
  Eigen::MatrixXd matrix;
  Eigen::LLT<Eigen::MatrixXd> factor;
  Eigen::VectorXd values;
};

namespace {

// Widths of joined cells; the ghost widths come from the neighbour ranks (0 where there is none).
std::vector<double> joined_widths(const std::vector<double>& fine, int joined, int direction,
                                  const Decomposition& blocks) {
  const int fine_cells = static_cast<int>(fine.size()) - 2;
  const int cells = (fine_cells + joined - 1) / joined;
  std::vector<double> width(cells + 2, 0.0);
  for (int i = 0; i < fine_cells; ++i) width[1 + i / joined] += fine[1 + i];
  for (int side = 0; side < 2; ++side) {
    const double& out = side == 0 ? width[1] : width[cells];
    double& in = side == 0 ? width[cells + 1] : width[0];
    MPI_Sendrecv(&out, 1, MPI_DOUBLE, blocks.neighbour(direction, side), side, &in, 1, MPI_DOUBLE,
                 blocks.neighbour(direction, 1 - side), side, blocks.communicator(),
                 MPI_STATUS_IGNORE);
  }
  return width;
}

// Global number of every cell of the coarsest level, ghosts by exchange; -1 outside the grid.
std::vector<float> numbered_cells(Level& level, const Decomposition& blocks, int first) {
  std::fill(level.x.begin(), level.x.end(), -1.0F);
  int n = first;
  for (int k = 0; k < level.size[2]; ++k)
    for (int j = 0; j < level.size[1]; ++j)
      for (int i = 0; i < level.size[0]; ++i) level.x[level.at(i, j, k)] = static_cast<float>(n++);
  level.fill_ghosts(blocks);
  return level.x;
}

long sum_of_cells(const Decomposition& blocks, long cells) {
  MPI_Allreduce(MPI_IN_PLACE, &cells, 1, MPI_LONG, MPI_SUM, blocks.communicator());
  return cells;
}

// Largest block size per direction over the ranks.
Index3 largest_size(const Decomposition& blocks, Index3 size) {
  MPI_Allreduce(MPI_IN_PLACE, size.data(), 3, MPI_INT, MPI_MAX, blocks.communicator());
  return size;
}

// Parity of the global index of this rank's first cell when every block has the size it has on this
// level; sizes[r] are those of all ranks and lower[r] their finest lower corners.
int global_parity(const std::vector<Index3>& lower, const std::vector<Index3>& sizes, int rank) {
  int sum = 0;
  for (int d = 0; d < 3; ++d) {
    const int e = (d + 1) % 3;
    const int f = (d + 2) % 3;
    for (std::size_t r = 0; r < lower.size(); ++r) {
      const bool same_row = lower[r][e] == lower[rank][e] && lower[r][f] == lower[rank][f];
      if (same_row && lower[r][d] < lower[rank][d]) sum += sizes[r][d];
    }
  }
  return sum & 1;
}

}  // namespace

Multigrid::~Multigrid() = default;

Multigrid::Multigrid(const Decomposition& decomposition)
    : decomposition_(decomposition), coarsest_(std::make_unique<Coarsest>()) {
  const Decomposition& blocks = decomposition_;
  std::vector<Index3> lower(blocks.size());
  std::vector<Index3> sizes(blocks.size());
  MPI_Allgather(blocks.block().lower.data(), 3, MPI_INT, lower.data(), 3, MPI_INT,
                blocks.communicator());
  MPI_Allgather(blocks.block().size.data(), 3, MPI_INT, sizes.data(), 3, MPI_INT,
                blocks.communicator());

  Vec3 spacing = blocks.grid().spacing();
  auto level = std::make_unique<Level>();
  level->allocate(blocks.block().size);
  level->parity = global_parity(lower, sizes, blocks.rank());
  for (int d = 0; d < 3; ++d) {
    const std::vector<double> uniform(level->size[d] + 2, spacing[d]);
    level->width[d] = joined_widths(uniform, 1, d, blocks);
  }
  for (;;) {
    levels_.push_back(std::move(level));
    Level& fine = *levels_.back();
    if (sum_of_cells(blocks, fine.cells()) <= coarsest_cells) break;
    const Index3 largest = largest_size(blocks, fine.size);
    double smallest = std::numeric_limits<double>::infinity();
    for (int d = 0; d < 3; ++d) {
      if (largest[d] > 1) smallest = std::min(smallest, spacing[d]);
    }
    Index3 size = fine.size;
    for (int d = 0; d < 3; ++d) {
      if (largest[d] == 1 || spacing[d] >= still_small * smallest) continue;
      fine.coarsening[d] = 2;
      spacing[d] *= 2;
      size[d] = (size[d] + 1) / 2;
      for (Index3& other : sizes) other[d] = (other[d] + 1) / 2;
    }
    if (fine.coarsening == std::array<int, 3>{1, 1, 1}) break;
    level = std::make_unique<Level>();
    level->allocate(size);
    level->parity = global_parity(lower, sizes, blocks.rank());
    for (int d = 0; d < 3; ++d) {
      level->width[d] = joined_widths(fine.width[d], fine.coarsening[d], d, blocks);
    }
  }

  Coarsest& last = *coarsest_;
  last.counts.resize(blocks.size());
  last.offsets.assign(blocks.size(), 0);
  const int own = static_cast<int>(levels_.back()->cells());
  MPI_Allgather(&own, 1, MPI_INT, last.counts.data(), 1, MPI_INT, blocks.communicator());
  for (int r = 1; r < blocks.size(); ++r)
    last.offsets[r] = last.offsets[r - 1] + last.counts[r - 1];
  last.total = last.offsets.back() + last.counts.back();
  last.values.resize(last.total);
  for (int r = 0; r < blocks.size(); ++r) {
    last.matrix_counts.push_back(last.counts[r] * last.total);
    last.matrix_offsets.push_back(last.offsets[r] * last.total);
  }
  last.number = numbered_cells(*levels_.back(), blocks, last.offsets[blocks.rank()]);
}

void Multigrid::set_coefficients(const PressureSystem& system) {
  Level& finest = *levels_.front();
  for (int k = 0; k <= finest.size[2]; ++k)
    for (int j = 0; j <= finest.size[1]; ++j) {
      const std::ptrdiff_t to = finest.at(0, j, k);
      const std::ptrdiff_t from = system.diagonal.index(0, j, k);
      for (int d = 0; d < 3; ++d) {
        const double* t = system.transmissibility[d].data() + from;
        float* face = finest.face[d].data() + to;
#pragma omp simd
        for (int i = 0; i <= finest.size[0]; ++i) face[i] = static_cast<float>(t[i]);
      }
      if (j == finest.size[1] || k == finest.size[2]) continue;
      const double* diagonal = system.diagonal.data() + from;
      float* outlet = finest.outlet.data() + to;
#pragma omp simd
      for (int i = 0; i < finest.size[0]; ++i) outlet[i] = static_cast<float>(diagonal[i]);
    }
  finest.set_inverse_diagonal();
  for (std::size_t l = 0; l + 1 < levels_.size(); ++l) {
    levels_[l]->coarsen_coefficients(*levels_[l + 1]);
    levels_[l + 1]->set_inverse_diagonal();
  }
  factor_coarsest();
}

void Multigrid::factor_coarsest() {
  const Level& last = *levels_.back();
  Coarsest& dense = *coarsest_;
  Eigen::MatrixXd& matrix = dense.matrix;
  matrix.setZero(dense.total, dense.total);
  int row = dense.offsets[decomposition_.rank()];
  for (int k = 0; k < last.size[2]; ++k)
    for (int j = 0; j < last.size[1]; ++j)
      for (int i = 0; i < last.size[0]; ++i, ++row) {
        const std::ptrdiff_t c = last.at(i, j, k);
        double diagonal = last.outlet[c];
        for (int d = 0; d < 3; ++d) {
          for (const std::ptrdiff_t upper : {std::ptrdiff_t{0}, last.stride[d]}) {
            const double coefficient = last.face[d][c + upper];
            const int other =
                static_cast<int>(dense.number[upper ? c + upper : c - last.stride[d]]);
            if (coefficient <= 0 || other < 0 || other == row) continue;
            matrix(other, row) -= coefficient;  // column-major: this rank's columns are contiguous
            diagonal += coefficient;
          }
        }
        matrix(row, row) += diagonal > 0 ? diagonal * (1 + 1e-6) : 1.0;
      }
  if (decomposition_.size() > 1) {
    MPI_Allgatherv(MPI_IN_PLACE, 0, MPI_DATATYPE_NULL, matrix.data(), dense.matrix_counts.data(),
                   dense.matrix_offsets.data(), MPI_DOUBLE, decomposition_.communicator());
  }
  dense.factor.compute(matrix);
}

void Multigrid::cycle(std::size_t index) {
  Level& level = *levels_[index];
  if (index + 1 == levels_.size()) {
    Coarsest& dense = *coarsest_;
    int n = dense.offsets[decomposition_.rank()];
    for (int k = 0; k < level.size[2]; ++k)
      for (int j = 0; j < level.size[1]; ++j)
        for (int i = 0; i < level.size[0]; ++i) dense.values[n++] = level.b[level.at(i, j, k)];
    if (decomposition_.size() > 1) {
      MPI_Allgatherv(MPI_IN_PLACE, 0, MPI_DATATYPE_NULL, dense.values.data(), dense.counts.data(),
                     dense.offsets.data(), MPI_DOUBLE, decomposition_.communicator());
    }
    dense.factor.solveInPlace(dense.values);
    n = dense.offsets[decomposition_.rank()];
    for (int k = 0; k < level.size[2]; ++k)
      for (int j = 0; j < level.size[1]; ++j)
        for (int i = 0; i < level.size[0]; ++i) {
          level.x[level.at(i, j, k)] = static_cast<float>(dense.values[n++]);
        }
    level.fill_ghosts(decomposition_);
    return;
  }

  level.smooth_from_zero(0);
  level.fill_ghosts(decomposition_);
  for (int half = 1; half < 2 * sweeps; ++half) {
    level.smooth(half & 1);
    level.fill_ghosts(decomposition_);
  }

  // The last sweep left no residual on colour 1, so only colour 0 is restricted.
  Level& coarse = *levels_[index + 1];
  const auto& joined = level.coarsening;
  const std::ptrdiff_t sy = level.stride[1];
  const std::ptrdiff_t sz = level.stride[2];
  const std::vector<float>& x = level.x;
  const std::vector<float>& tx = level.face[0];
  const std::vector<float>& ty = level.face[1];
  const std::vector<float>& tz = level.face[2];
  std::fill(coarse.b.begin(), coarse.b.end(), 0.0F);
  for (int k = 0; k < level.size[2]; ++k)
    for (int j = 0; j < level.size[1]; ++j) {
      const std::ptrdiff_t row = level.at(0, j, k);
      const std::ptrdiff_t coarse_row = coarse.at(0, j / joined[1], k / joined[2]);
      const int shift = joined[0] - 1;
      for (int i = (level.parity + j + k) & 1; i < level.size[0]; i += 2) {
        const std::ptrdiff_t c = row + i;
        if (level.inverse_diagonal[c] == 0) continue;
        coarse.b[coarse_row + (i >> shift)] += level.b[c] - x[c] / level.inverse_diagonal[c] +
                                               tx[c] * x[c - 1] + tx[c + 1] * x[c + 1] +
                                               ty[c] * x[c - sy] + ty[c + sy] * x[c + sy] +
                                               tz[c] * x[c - sz] + tz[c + sz] * x[c + sz];
      }
    }

  cycle(index + 1);

  for (int k = 0; k < level.size[2]; ++k)
    for (int j = 0; j < level.size[1]; ++j) {
      const std::ptrdiff_t row = level.at(0, j, k);
      const std::ptrdiff_t coarse_row = coarse.at(0, j / joined[1], k / joined[2]);
      const int shift = joined[0] - 1;
      for (int i = 0; i < level.size[0]; ++i)
        level.x[row + i] += coarse.x[coarse_row + (i >> shift)];
    }
  level.fill_ghosts(decomposition_);
  for (int half = 2 * sweeps - 1; half >= 0; --half) {
    level.smooth(half & 1);
    level.fill_ghosts(decomposition_);
  }
}

void Multigrid::apply(const Field& residual, double scale, Field& result) {
  Level& finest = *levels_.front();
  for (int k = 0; k < finest.size[2]; ++k)
    for (int j = 0; j < finest.size[1]; ++j) {
      const std::ptrdiff_t row = finest.at(0, j, k);
      const std::ptrdiff_t from = residual.index(0, j, k);
      for (int i = 0; i < finest.size[0]; ++i) {
        finest.b[row + i] = static_cast<float>(residual[from + i] * scale);
      }
    }
  cycle(0);
  const double inverse = 1 / scale;
  for (int k = 0; k < finest.size[2]; ++k)
    for (int j = 0; j < finest.size[1]; ++j) {
      const std::ptrdiff_t row = finest.at(0, j, k);
      const std::ptrdiff_t to = result.index(0, j, k);
      for (int i = 0; i < finest.size[0]; ++i) result[to + i] = finest.x[row + i] * inverse;
    }
}

}  // namespace gasgrain::cfd
