// The operator D that spreads what grains carry over the cells, and its transpose that gathers cell
// values to the grains.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <tuple>
#include <vector>

#include "coupling/smoothing.hpp"

namespace gasgrain::coupling {

// Quadratic B-spline weights at the cells -1, 0, 1 around the cell that holds the grain; `offset`
// in
// [-1/2, 1/2] is the distance from the cell centre over the spacing.
std::array<double, 3> spline_weights(double offset);

class Deposition {
 public:
  // Keeps a reference to `decomposition`.
  Deposition(const cfd::Decomposition& decomposition, const cfd::WallGeometry& walls);

  // After the walls moved; to be followed by locate().
  void set_walls(const cfd::WallGeometry& walls) { smoothing_.set_walls(walls); }

  // Standard deviation of the kernel, m; see plan_smoothing().
  void set_width(double width);
  const SmoothingPlan& plan() const { return smoothing_.plan(); }
  const cfd::Field& open_fraction() const { return smoothing_.open_fraction(); }

  // Takes the grains' positions; each must lie in a cell of this rank's block. A grain around which
  // every cell is closed takes no part: it deposits nothing and gathers zeros.
  void locate(std::span<const Vec3> positions);
  std::size_t size() const { return stencils_.size(); }
  bool takes_part(std::size_t grain) const { return stencils_[grain].weight > 0; }

  // D: cells[c] = deposited amount of component c per open volume, in owned cells. Amounts are
  // stored grain by grain, all components of a grain adjacent. Collective.
  template <int components>
  void deposit(const std::array<cfd::Field*, components>& cells,
               std::span<const std::array<double, components>> amounts);

  // Transpose of D times the open volume of cells: the kernel's mean of cells[c] around each grain,
  // from owned cells. Collective.
  template <int components>
  void gather(std::span<std::array<double, components>> values,
              const std::array<const cfd::Field*, components>& cells);

 private:
  struct Stencil {
    std::ptrdiff_t centre = 0;                      // index of the cell that holds the grain
    std::array<std::array<double, 3>, 3> spline{};  // [direction][-1, 0, 1]
    double weight = 0;  // 1 / sum of spline weights times (1 - alpha); 0: takes no part
  };

  const cfd::Decomposition& decomposition_;
  Smoothing smoothing_;
  std::vector<Stencil> stencils_;
  std::tuple<CellArray<1>, CellArray<2>, CellArray<4>, CellArray<6>> buffers_;
};

}  // namespace gasgrain::coupling
