// Two cells of a void belong together when gas can move through the face between them. The flood
// fill is that of the gas's regions; cells above the bed's surface play the part of its outlets.
#include "coupling/bubbles.hpp"

#include "cfd/gas_regions.hpp"
#include "cfd/halo_exchange.hpp"
#include "cfd/loops.hpp"

namespace gasgrain::coupling {

namespace {

// Height of the middle of local layer `at` above the lower end, m.
double height_of(const cfd::Decomposition& decomposition, const Vertical& vertical, int at) {
  const int layer = decomposition.block().lower[vertical.axis] + at;
  const int layers = decomposition.grid().cells[vertical.axis];
  const double spacing = decomposition.grid().spacing()[vertical.axis];
  return ((vertical.up > 0 ? layer : layers - 1 - layer) + 0.5) * spacing;
}

double smallest_bubble(const cfd::Grid& grid) {  // cells
  double cells = 1.0;
  for (int d = 0; d < 3; ++d) cells *= grid.cells[d] > 1 ? 2.0 : 1.0;
  return cells;
}

}  // namespace

Bubbles find_bubbles(const cfd::GasSolver& gas, const BedCells& bed, const Vertical& vertical,
                     const BubbleLimits& limits) {
  const cfd::Decomposition& decomposition = gas.decomposition();
  const cfd::Index3 size = decomposition.block().size;
  cfd::Field in_void(size), freeboard(size);
  cfd::for_each_cell(size, [&](int i, int j, int k) {
    if (bed.open_fraction(i, j, k) <= 0 || bed.void_fraction(i, j, k) <= limits.void_fraction)
      return;
    in_void(i, j, k) = 1.0;
    const int at = cfd::Index3{i, j, k}[vertical.axis];
    if (height_of(decomposition, vertical, at) > limits.surface) freeboard(i, j, k) = 1.0;
  });
  cfd::fill_ghosts(decomposition, in_void);
  cfd::VectorField joined;
  for (int d = 0; d < 3; ++d) {
    joined[d] = cfd::Field(size);
    cfd::Index3 faces = size;
    ++faces[d];
    cfd::for_each_cell(faces, [&](int i, int j, int k) {
      const std::ptrdiff_t n = in_void.index(i, j, k);
      const bool both = in_void[n] > 0 && in_void[n - in_void.stride(d)] > 0;
      if (both && gas.walls().open_area[d][n] > 0) joined[d][n] = 1.0;
    });
  }
  const cfd::GasRegions regions = cfd::find_gas_regions(decomposition, joined, freeboard);
  const std::vector<double> open = cfd::sum_per_region(decomposition, regions, bed.open_fraction);
  Bubbles bubbles;
  for (std::size_t r = 0; r < regions.regions.size(); ++r) {
    const cfd::GasRegion& region = regions.regions[r];
    if (region.has_outlet || region.cells < smallest_bubble(decomposition.grid())) continue;
    ++bubbles.count;
    bubbles.volume += open[r] * decomposition.grid().cell_volume();
  }
  return bubbles;
}

}  // namespace gasgrain::coupling
