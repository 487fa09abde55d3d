#include "coupling/bed_monitor.hpp"

#include <algorithm>
#include <cmath>

#include "cfd/loops.hpp"

namespace gasgrain::coupling {

namespace {

constexpr double surface_void_fraction =
    0.8;  // of the bed, as the iso-surface of the paper's fig 3b

}  // namespace

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
  layer_height_ = grid.spacing()[vertical.axis];
  cfd::Field one(open_fraction.size(), 1.0);
  open_cells_ = layer_sums(one);
}

// Per layer from below: sum over the cells of (1 - alpha) times the field; over all ranks.
std::vector<double> BedMonitor::layer_sums(const cfd::Field& field) const {
  const cfd::Decomposition& decomposition = gas_.decomposition();
  const int axis = vertical_.axis, layers = decomposition.grid().cells[axis];
  std::vector<double> sums(layers, 0.0);
  cfd::for_each_cell(decomposition.block().size, [&](int i, int j, int k) {
    const int layer = decomposition.block().lower[axis] + cfd::Index3{i, j, k}[axis];
    sums[layer] += open_fraction_(i, j, k) * field(i, j, k);
  });
  MPI_Allreduce(MPI_IN_PLACE, sums.data(), layers, MPI_DOUBLE, MPI_SUM,
                decomposition.communicator());
  if (vertical_.up < 0) std::reverse(sums.begin(), sums.end());
  return sums;
}

double BedMonitor::height(const cfd::Field& void_fraction) const {
  const std::vector<double> sums = layer_sums(void_fraction);
  double above = 1.0;  // mean void fraction of the next open layer above
  int layer_above = static_cast<int>(sums.size());
  for (int layer = layer_above - 1; layer >= 0; --layer) {
    if (open_cells_[layer] <= 0) continue;
    const double mean = sums[layer] / open_cells_[layer];
    if (mean < surface_void_fraction) {
      if (layer_above == static_cast<int>(sums.size())) return layer_above * layer_height_;
      const double share = (surface_void_fraction - mean) / (above - mean);
      return (layer + 0.5 + share * (layer_above - layer)) * layer_height_;
    }
    above = mean;
    layer_above = layer;
  }
  return 0.0;
}

double BedMonitor::pressure_drop() const {
  return gas_.side_pressure(vertical_.axis, vertical_.lower_side()) -
         gas_.side_pressure(vertical_.axis, vertical_.upper_side());
}

double BedMonitor::open_volume_below(double height) const {
  double cells = 0;
  for (std::size_t layer = 0; layer < open_cells_.size(); ++layer) {
    cells += open_cells_[layer] * std::clamp(height / layer_height_ - double(layer), 0.0, 1.0);
  }
  return cells * gas_.decomposition().grid().cell_volume();
}

}  // namespace gasgrain::coupling
