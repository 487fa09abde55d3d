// The operator D that spreads what grains carry over the cells, and its transpose that gathers cell
// values to the grains.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <tuple>
#include <vector>

#include "coupling/listed_shares.hpp"
#include "coupling/smoothing.hpp"
#include "coupling/spline_shares.hpp"

namespace gasgrain::coupling {

class Deposition {
 public:
  // Keeps a reference to `decomposition`.
  Deposition(const cfd::Decomposition& decomposition, const cfd::WallGeometry& walls,
             Mapping mapping = Mapping::spline);

  Mapping mapping() const { return listed_ ? listed_->mapping() : Mapping::spline; }

  // After the walls moved; to be followed by locate(). Collective.
  void set_walls(const cfd::WallGeometry& walls);

  // Standard deviation of the kernel, m, reached by smoothing, and the largest diameter of a grain,
  // m, equal on all ranks, which only matters for mappings that depend on it. 0: no smoothing.
  // To be followed by locate(). Collective; throws UserError (ListedShares::prepare).
  void set_width(double width, double largest_diameter = 0.0);
  const SmoothingPlan& plan() const { return smoothing_.plan(); }
  const cfd::Field& open_fraction() const { return smoothing_.open_fraction(); }

  // Takes the grains' positions; each must lie in a cell of this rank's block. A grain around which
  // every cell is closed takes no part: it deposits nothing and gathers zeros. The B-spline does
  // not look at `diameters` [m]; other mappings need one per grain. Collective.
  void locate(std::span<const Vec3> positions, std::span<const double> diameters = {});
  bool takes_part(std::size_t grain) const {
    return listed_ ? listed_->takes_part(grain) : spline_.takes_part(grain);
  }

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
  void find_range();
  // Zero wherever range_ reaches.
  template <int components>
  CellArray<components>& cleared_buffer();

  const cfd::Decomposition& decomposition_;
  Smoothing smoothing_;
  SplineShares spline_;                 // the mapping unless listed_ is there
  double largest_diameter_ = 0.0;       // m
  CellRange range_;                     // cells that grains reach, smoothing included
  std::optional<ListedShares> listed_;  // of other mappings than the B-spline
  std::tuple<CellArray<1>, CellArray<2>, CellArray<3>, CellArray<4>, CellArray<6>> buffers_;
};

}  // namespace gasgrain::coupling
