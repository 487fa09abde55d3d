// Shares of grains in the 27 cells around them by the quadratic B-spline: the default mapping.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "cfd/grid.hpp"
#include "coupling/cell_array.hpp"

namespace gasgrain::coupling {

// T of coupling/void_fraction.cpp and its transpose for the B-spline. Works on cells in the layout
// of cfd::Field with ghosts on all sides; exchanges none.
class SplineShares {
 public:
  // Keeps a reference to `decomposition`.
  explicit SplineShares(const cfd::Decomposition& decomposition) : decomposition_(decomposition) {}

  // Open share of each cell, 1 - alpha, ghosts filled. Keeps a reference. To be followed by
  // locate().
  void prepare(const cfd::Field& open_fraction);

  // Centres in this rank's block.
  void locate(std::span<const Vec3> positions);
  bool takes_part(std::size_t grain) const { return places_[grain].weight > 0; }

  // Cells of the block that hold the centres.
  const cfd::IndexBox& occupied() const { return occupied_; }

  // density[cell] += T amounts per open volume, in owned cells and one layer of ghosts.
  template <int components>
  void spread(CellArray<components>& density,
              std::span<const std::array<double, components>> amounts) const;
  // Transpose: the mean of `weighted` (values times 1 - alpha, ghosts filled) around each grain.
  template <int components>
  void collect(std::span<std::array<double, components>> values,
               const CellArray<components>& weighted) const;

 private:
  struct Place {
    std::ptrdiff_t cell;  // index of the cell that holds the grain
    Vec3 offset;          // from its centre over the spacing, in [-1/2, 1/2]
    double weight;        // 1 / sum of shares times (1 - alpha); 0: takes no part
  };

  const cfd::Decomposition& decomposition_;
  const cfd::Field* open_fraction_ = nullptr;
  std::vector<char> surrounded_;  // per cell: 27 fully open cells
  std::vector<Place> places_;
  cfd::IndexBox occupied_{};
};

}  // namespace gasgrain::coupling
