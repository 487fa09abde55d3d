#include "coupling/bed_monitor.hpp"

#include <algorithm>
#include <cmath>

#include "cfd/halo_exchange.hpp"
#include "cfd/loops.hpp"

namespace gasgrain::coupling {

Vertical vertical_of(const Vec3& gravity) {
  Vertical vertical;
  if (gravity.isZero()) return vertical;
  gravity.cwiseAbs().maxCoeff(&vertical.axis);
  vertical.up = gravity[vertical.axis] < 0 ? 1 : -1;
  return vertical;
}

BedMonitor::BedMonitor(const cfd::GasSolver& gas, const cfd::Field& open_fraction,
                       const Vertical& vertical)
    : gas_(gas), open_fraction_(open_fraction), vertical_(vertical) {
  const cfd::Grid& grid = gas.decomposition().grid();
  const Vec3 extent = grid.upper - grid.lower;
  cross_section_ = extent.prod() / extent[vertical.axis];
  layers_.thickness = grid.spacing()[vertical.axis];
  layers_.cell_volume = grid.cell_volume();
}

void BedMonitor::observe(const cfd::Field& void_fraction) {
  const cfd::Decomposition& decomposition = gas_.decomposition();
  const int axis = vertical_.axis, layers = decomposition.grid().cells[axis];
  std::vector<double> sums(2 * static_cast<std::size_t>(layers), 0.0);  // open, then gas
  cfd::for_each_cell(decomposition.block().size, [&](int i, int j, int k) {
    const int at = decomposition.block().lower[axis] + cfd::Index3{i, j, k}[axis];
    const int layer = vertical_.up > 0 ? at : layers - 1 - at;
    const double open = open_fraction_(i, j, k);
    sums[layer] += open;
    sums[layers + layer] += open * void_fraction(i, j, k);
  });
  cfd::sum_over_ranks(decomposition, sums);
  layers_.open_cells.assign(sums.begin(), sums.begin() + layers);
  layers_.void_fraction.assign(layers, 1.0);
  for (int layer = 0; layer < layers; ++layer) {
    if (sums[layer] > 0) layers_.void_fraction[layer] = sums[layers + layer] / sums[layer];
  }
}

double BedMonitor::pressure_drop() const {
  return gas_.side_pressure(vertical_.axis, vertical_.lower_side()) -
         gas_.side_pressure(vertical_.axis, vertical_.upper_side());
}

}  // namespace gasgrain::coupling
