// A grain's shares are products of three times three weights (mapping.hpp), computed anew for each
// deposit and gather from its place: cheaper than to read 27 numbers, or nine, from memory. Cells
// and their components are adjacent along x, so the 27 cells are nine rows of 3 x components
// numbers, each row a few vector instructions. Where all 27 cells are fully open the shares add up
// to one and the sum over them is left out.
#include "coupling/spline_shares.hpp"

#include <algorithm>
#include <cmath>

#include "cfd/loops.hpp"
#include "coupling/mapping.hpp"
#include "coupling/shared/error.hpp"

namespace gasgrain::coupling {

namespace {

// Numbers of three cells in a row, and for vector instructions those of a fourth cell with weight
// 0.
template <int components>
inline constexpr int row_length =
    components < 4 ? 4 * stored_components<components> : 3 * stored_components<components>;

constexpr double least_open_sum = 1e-12;  // below: nothing but closed cells around the grain

struct Weights {
  std::array<double, 3> x, y, z;  // of the cells -1, 0, 1

  explicit Weights(const Vec3& offset)
      : x(spline_weights(offset[0])), y(spline_weights(offset[1])), z(spline_weights(offset[2])) {}
};

// visit(index of a row's first cell relative to the centre, weight of the row) for the nine rows.
template <class Visit>
void for_each_row(const Weights& weights, const cfd::Field& like, const Visit& visit) {
  const std::ptrdiff_t sy = like.stride(1), sz = like.stride(2);
#pragma GCC unroll 3
  for (int c = -1; c <= 1; ++c) {
#pragma GCC unroll 3
    for (int b = -1; b <= 1; ++b) visit(c * sz + b * sy - 1, weights.z[c + 1] * weights.y[b + 1]);
  }
}

double open_sum(const Weights& weights, const cfd::Field& open, std::ptrdiff_t cell) {
  double sum = 0;
  for_each_row(weights, open, [&](std::ptrdiff_t first, double weight) {
    const double* row = open.data() + cell + first;
    sum += weight * (weights.x[0] * row[0] + weights.x[1] * row[1] + weights.x[2] * row[2]);
  });
  return sum;
}

}  // namespace

void SplineShares::prepare(const cfd::Field& open_fraction) {
  open_fraction_ = &open_fraction;
  surrounded_.assign(open_fraction.count(), 0);
  const std::ptrdiff_t sy = open_fraction.stride(1), sz = open_fraction.stride(2);
  cfd::for_each_cell(open_fraction.size(), [&](int i, int j, int k) {
    const std::ptrdiff_t n = open_fraction.index(i, j, k);
    bool all = true;
    for (int c = -1; c <= 1; ++c)
      for (int b = -1; b <= 1; ++b)
        for (int a = -1; a <= 1; ++a) all = all && open_fraction[n + a + b * sy + c * sz] == 1.0;
    surrounded_[n] = all;
  });
}

void SplineShares::locate(std::span<const Vec3> positions) {
  GASGRAIN_ASSERT(open_fraction_ != nullptr);
  const cfd::Field& open = *open_fraction_;
  const cfd::Grid& grid = decomposition_.grid();
  const cfd::Block& block = decomposition_.block();
  const Vec3 spacing = grid.spacing();
  occupied_ = {block.size, {0, 0, 0}};
  places_.resize(positions.size());
  for (std::size_t n = 0; n < positions.size(); ++n) {
    const Vec3 in_cells = (positions[n] - grid.lower).cwiseQuotient(spacing);
    Place& place = places_[n];
    cfd::Index3 local;
    for (int d = 0; d < 3; ++d) {
      const double cell = std::floor(in_cells[d]);
      local[d] = static_cast<int>(cell) - block.lower[d];
      GASGRAIN_ASSERT(local[d] >= 0 && local[d] < block.size[d]);
      occupied_.begin[d] = std::min(occupied_.begin[d], local[d]);
      occupied_.end[d] = std::max(occupied_.end[d], local[d] + 1);
      place.offset[d] = in_cells[d] - cell - 0.5;
    }
    place.cell = open.index(local[0], local[1], local[2]);
    place.weight = 1.0;
    if (surrounded_[place.cell]) continue;
    const double sum = open_sum(Weights(place.offset), open, place.cell);
    place.weight = sum > least_open_sum ? 1.0 / sum : 0.0;
  }
}

template <int components>
void SplineShares::spread(CellArray<components>& density,
                          std::span<const std::array<double, components>> amounts) const {
  GASGRAIN_ASSERT(amounts.size() == places_.size());
  constexpr int stored = stored_components<components>;
  const double per_volume = 1.0 / decomposition_.grid().cell_volume();
  double* const cells = density.front().data();
  for (std::size_t n = 0; n < places_.size(); ++n) {
    const Place& place = places_[n];
    const Weights weights(place.offset);
    std::array<double, row_length<components>> along{};
    for (int a = 0; a < 3; ++a)
      for (int m = 0; m < components; ++m)
        along[a * stored + m] = place.weight * per_volume * weights.x[a] * amounts[n][m];
    for_each_row(weights, *open_fraction_, [&](std::ptrdiff_t first, double weight) {
      double* const row = cells + (place.cell + first) * stored;
#pragma omp simd
      for (int m = 0; m < row_length<components>; ++m) row[m] += weight * along[m];
    });
  }
}

template <int components>
void SplineShares::collect(std::span<std::array<double, components>> values,
                           const CellArray<components>& weighted) const {
  GASGRAIN_ASSERT(values.size() == places_.size());
  constexpr int stored = stored_components<components>;
  const double* const cells = weighted.front().data();
  for (std::size_t n = 0; n < places_.size(); ++n) {
    const Place& place = places_[n];
    const Weights weights(place.offset);
    std::array<double, row_length<components>> along{};
    for_each_row(weights, *open_fraction_, [&](std::ptrdiff_t first, double weight) {
      const double* const row = cells + (place.cell + first) * stored;
#pragma omp simd
      for (int m = 0; m < row_length<components>; ++m) along[m] += weight * row[m];
    });
    for (int m = 0; m < components; ++m) {
      double sum = 0;
      for (int a = 0; a < 3; ++a) sum += weights.x[a] * along[a * stored + m];
      values[n][m] = place.weight * sum;
    }
  }
}

#define GASGRAIN_INSTANTIATE(components)                                                     \
  template void SplineShares::spread<components>(                                            \
      CellArray<components>&, std::span<const std::array<double, components>>) const;        \
  template void SplineShares::collect<components>(std::span<std::array<double, components>>, \
                                                  const CellArray<components>&) const;
GASGRAIN_FOR_COMPONENTS(GASGRAIN_INSTANTIATE)
#undef GASGRAIN_INSTANTIATE

}  // namespace gasgrain::coupling
