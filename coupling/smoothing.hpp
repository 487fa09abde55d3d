// Conservative diffusion of cell fields within the open space: widens the deposition kernel.
#pragma once

#include <tuple>

#include "cfd/field.hpp"
#include "cfd/grid.hpp"
#include "cfd/loops.hpp"
#include "cfd/wall_geometry.hpp"
#include "coupling/cell_array.hpp"

namespace gasgrain::coupling {

// How often and how strongly to smooth.
struct SmoothingPlan {
  int sweeps = 0;
  Vec3 number = Vec3::Zero();  // lambda per direction and sweep, in [0, 1/8]
};

// The least number of sweeps that widens a kernel of the given variance per direction, in dx^2, to
// the standard deviation `width` [m]. Directions of a single cell are not smoothed.
SmoothingPlan plan_smoothing(const cfd::Grid& grid, double width, const Vec3& variance);

// Cells of a block that take part, and those with one more layer around them, ghosts included, of
// which the others are zero. Both are cut from boxes of the whole grid, the same on all ranks.
struct CellRange {
  cfd::IndexBox cells, with_ring;
};

class Smoothing {
 public:
  // Keeps a reference to `decomposition`.
  Smoothing(const cfd::Decomposition& decomposition, const cfd::WallGeometry& walls);

  // After the walls moved; keeps the plan.
  void set_walls(const cfd::WallGeometry& walls);

  void set_plan(const SmoothingPlan& plan);
  const SmoothingPlan& plan() const { return plan_; }

  // Open share of each cell, 1 - alpha; 0 in cells that no open face connects to others and outside
  // the grid. Ghosts filled.
  const cfd::Field& open_fraction() const { return open_fraction_; }

  // All sweeps, in place, on intensive values (amount per open volume). Collective; ghosts are
  // overwritten and stale afterwards.
  template <int components>
  void apply(CellArray<components>& cells) {
    apply<components>(cells, {{{0, 0, 0}, open_fraction_.size()}, {}});
  }

  // The same on some owned cells only; beyond them values count as zero.
  template <int components>
  void apply(CellArray<components>& cells, const CellRange& range);

 private:
  template <int components>
  void sweep(CellArray<components>& cells, const cfd::IndexBox& box);

  const cfd::Decomposition& decomposition_;
  SmoothingPlan plan_;
  cfd::Field open_fraction_;
  cfd::Field inverse_open_fraction_;  // 0 in closed cells
  cfd::VectorField passage_;          // min(1 - alpha) of the two cells of an open face, else 0
  cfd::VectorField conductance_;      // lambda * passage
  std::tuple<CellArray<1>, CellArray<2>, CellArray<3>, CellArray<4>, CellArray<6>> scratch_;
};

}  // namespace gasgrain::coupling
