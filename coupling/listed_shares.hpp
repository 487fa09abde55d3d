// Cells and shares of every grain as a list: the mappings that are there to be compared with.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "cfd/grid.hpp"
#include "coupling/cell_array.hpp"
#include "coupling/mapping.hpp"

namespace gasgrain::coupling {

// T of coupling/void_fraction.cpp and its transpose for any mapping. Works on cells of its own with
// as many layers of ghosts as the largest grain reaches; all members but locate() are collective.
class ListedShares {
 public:
  // Keeps a reference to `decomposition`.
  ListedShares(const cfd::Decomposition& decomposition, Mapping mapping)
      : decomposition_(decomposition), mapping_(mapping) {}

  Mapping mapping() const { return mapping_; }

  // Open share of each owned cell, 1 - alpha, and the largest diameter of a grain [m], equal on all
  // ranks. To be followed by locate(). Throws UserError when a grain reaches beyond the blocks next
  // to its own.
  void prepare(const cfd::Field& open_fraction, double largest_diameter);

  // Centres in this rank's block and diameters [m].
  void locate(std::span<const Vec3> positions, std::span<const double> diameters);
  bool takes_part(std::size_t grain) const { return weights_[grain] > 0; }

  // density[cell] += T amounts per open volume in owned cells; indexed as cfd::Field is.
  template <int components>
  void spread(CellArray<components>& density,
              std::span<const std::array<double, components>> amounts) const;
  // Transpose: the mean of `weighted` (values times 1 - alpha, owned cells) around each grain.
  template <int components>
  void collect(std::span<std::array<double, components>> values,
               const CellArray<components>& weighted) const;

 private:
  struct Entry {
    std::ptrdiff_t cell;  // in the layout of ghosts_
    double share;
  };

  // The grain's shares as entries; returns the sum of share times open fraction.
  double list(Mapping mapping, const cfd::Index3& cell, const Vec3& offset, const Vec3& radius);

  const cfd::Decomposition& decomposition_;
  Mapping mapping_;
  GhostLayers ghosts_;
  CellArray<1> open_fraction_;
  std::vector<Entry> entries_;      // grain by grain
  std::vector<std::size_t> begin_;  // of a grain's entries; one more than grains
  std::vector<double> weights_;     // 1 / sum of shares times (1 - alpha); 0: takes no part
  std::vector<CellShare> shares_;   // of the grain under way
};

}  // namespace gasgrain::coupling
