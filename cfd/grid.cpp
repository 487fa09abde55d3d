#include "cfd/grid.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "coupling/shared/error.hpp"

namespace gasgrain::cfd {

namespace {

// Layers are cut in whole units, the last of which may be shorter: the coarse cells of a multigrid
// solver then end at the blocks' borders.
struct Cut {
  int parts, layers, unit;

  int units() const { return (layers + unit - 1) / unit; }
  // First layer of a part; `parts` gives the end of the last one.
  int first(int part) const {
    const long long units_below = static_cast<long long>(part) * units() / parts;
    return std::min(layers, static_cast<int>(units_below) * unit);
  }
  int part_of(int layer) const {
    return static_cast<int>((static_cast<long long>(layer / unit + 1) * parts - 1) / units());
  }
  int largest() const {
    int most = 0;
    for (int part = 0; part < parts; ++part) most = std::max(most, first(part + 1) - first(part));
    return most;
  }
};

// The largest unit that makes no part more than a few per cent longer than the mean.
Cut cut(int parts, int layers) {
  constexpr int largest_unit = 16;
  constexpr double longer = 1.03;
  for (int unit = largest_unit; unit > 1; unit /= 2) {
    const Cut units{parts, layers, unit};
    if (units.units() >= parts && units.largest() * parts <= longer * layers) return units;
  }
  return {parts, layers, 1};
}

std::string text(const Index3& n) {
  std::ostringstream out;
  out << n[0] << " x " << n[1] << " x " << n[2];
  return out.str();
}

bool fits(const Index3& ranks, const Index3& cells) {
  return ranks[0] <= cells[0] && ranks[1] <= cells[1] && ranks[2] <= cells[2];
}

// Cell faces between blocks of different ranks.
long long cut_faces(const Index3& ranks, const Index3& cells, const std::array<bool, 3>& periodic) {
  long long faces = 0;
  for (int d = 0; d < 3; ++d) {
    const long long cuts = ranks[d] == 1 ? 0 : ranks[d] - (periodic[d] ? 0 : 1);
    faces += cuts * cells[(d + 1) % 3] * cells[(d + 2) % 3];
  }
  return faces;
}

Index3 least_surface_ranks(int size, const Index3& cells, const std::array<bool, 3>& periodic) {
  Index3 best{0, 0, 0};
  long long least = -1;
  for (int x = 1; x <= size; ++x) {
    if (size % x != 0) continue;
    for (int y = 1; y <= size / x; ++y) {
      if ((size / x) % y != 0) continue;
      const Index3 ranks{x, y, size / x / y};
      if (!fits(ranks, cells)) continue;
      const long long faces = cut_faces(ranks, cells, periodic);
      if (least < 0 || faces < least) {
        least = faces;
        best = ranks;
      }
    }
  }
  if (least < 0) {
    throw UserError("a grid of " + text(cells) + " cells cannot be cut into " +
                    std::to_string(size) +
                    " blocks of at least one layer each; start fewer ranks or use more cells");
  }
  return best;
}

void check_prescribed(const Index3& ranks, int size, const Index3& cells) {
  if (ranks[0] * ranks[1] * ranks[2] != size) {
    throw UserError("numerics.ranks = " + text(ranks) + " does not make the " +
                    std::to_string(size) +
                    " ranks the program runs on; leave numerics.ranks out to have it chosen");
  }
  if (!fits(ranks, cells)) {
    throw UserError("numerics.ranks = " + text(ranks) + " has more parts than the grid of " +
                    text(cells) + " cells has layers; use fewer parts in that direction");
  }
}

}  // namespace

Index3 Grid::cell_of(const Vec3& x) const {
  const Vec3 h = spacing();
  Index3 cell{};
  for (int d = 0; d < 3; ++d) cell[d] = static_cast<int>(std::floor((x[d] - lower[d]) / h[d]));
  return cell;
}

Decomposition::Decomposition(MPI_Comm communicator, const Grid& grid,
                             const std::array<bool, 3>& periodic, const Index3& ranks)
    : communicator_(communicator), grid_(grid), periodic_(periodic), ranks_(ranks) {
  int size = 1;
  MPI_Comm_rank(communicator, &rank_);
  MPI_Comm_size(communicator, &size);
  if (ranks[0] > 0 && ranks[1] > 0 && ranks[2] > 0) {
    check_prescribed(ranks, size, grid.cells);
  } else {
    ranks_ = least_surface_ranks(size, grid.cells, periodic);
  }
  const Index3 part{rank_ % ranks_[0], rank_ / ranks_[0] % ranks_[1],
                    rank_ / ranks_[0] / ranks_[1]};
  const Index3 stride{1, ranks_[0], ranks_[0] * ranks_[1]};
  for (int d = 0; d < 3; ++d) {
    const Cut layers = cut(ranks_[d], grid.cells[d]);
    unit_[d] = layers.unit;
    block_.lower[d] = layers.first(part[d]);
    block_.size[d] = layers.first(part[d] + 1) - block_.lower[d];
    for (int side = 0; side < 2; ++side) {
      const int other = part[d] + (side == 0 ? -1 : 1);
      const bool outside = other < 0 || other >= ranks_[d];
      const int wrapped = (other + ranks_[d]) % ranks_[d];
      neighbours_[d][side] =
          outside && !periodic[d] ? MPI_PROC_NULL : rank_ + (wrapped - part[d]) * stride[d];
    }
  }
}

int Decomposition::owner(const Index3& cell) const {
  Index3 part{};
  for (int d = 0; d < 3; ++d) {
    GASGRAIN_ASSERT(cell[d] >= 0 && cell[d] < grid_.cells[d]);
    part[d] = Cut{ranks_[d], grid_.cells[d], unit_[d]}.part_of(cell[d]);
  }
  return part[0] + ranks_[0] * (part[1] + ranks_[1] * part[2]);
}

}  // namespace gasgrain::cfd
