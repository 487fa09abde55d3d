// Explicit diffusion sweep on the solid volume per open volume phi_i:
//
//   (1 - alpha_i) (phi_i' - phi_i) = sum over open faces of lambda min(1 - alpha_i, 1 - alpha_j)
//   (phi_j - phi_i)
//
// The flux through a face leaves one cell and enters the other, so the sum of (1 - alpha) V phi is
// kept to round-off; nothing passes closed faces or the sides of the grid. With O = diag(1 - alpha)
// and L the symmetric matrix of fluxes the sweep of volumes q = O V phi is S = I - L O^-1, and its
// transpose, which the gather needs, is I - O^-1 L: the same operation on an intensive field. One
// function therefore serves both.
// A sweep adds 2 lambda dx^2 to the variance in each direction. lambda <= 1/8 keeps the coefficient
// of phi_i at or above 1/4 in three dimensions, so no new extremes appear.
// Source: Pirker, Kahrimanovic, Goniva, Appl. Math. Model. 35 (2011) 2479 (diffusive smoothing);
// the aperture weights are ours.
#include "coupling/smoothing.hpp"

#include <algorithm>
#include <cmath>

#include "cfd/halo_exchange.hpp"
#include "cfd/loops.hpp"

namespace gasgrain::coupling {

namespace {

constexpr double largest_number = 1.0 / 8.0;  // lambda per direction

cfd::Field connected_open_fraction(const cfd::Decomposition& decomposition,
                                   const cfd::WallGeometry& walls) {
  const cfd::Index3 size = decomposition.block().size;
  cfd::Field open(size);
  cfd::for_each_cell(size, [&](int i, int j, int k) {
    const double area = walls.open_area[0](i, j, k) + walls.open_area[0](i + 1, j, k) +
                        walls.open_area[1](i, j, k) + walls.open_area[1](i, j + 1, k) +
                        walls.open_area[2](i, j, k) + walls.open_area[2](i, j, k + 1);
    open(i, j, k) = area > 0 ? 1.0 - walls.wall_fraction(i, j, k) : 0.0;
  });
  cfd::fill_ghosts(decomposition, open);
  return open;
}

}  // namespace

SmoothingPlan plan_smoothing(const cfd::Grid& grid, double width, const Vec3& variance) {
  const Vec3 spacing = grid.spacing();
  SmoothingPlan plan;
  for (int d = 0; d < 3; ++d) {
    if (grid.cells[d] == 1) continue;
    const double wanted = width * width / (spacing[d] * spacing[d]);
    plan.number[d] = std::max(0.0, 0.5 * (wanted - variance[d]));
  }
  plan.sweeps = static_cast<int>(std::ceil(plan.number.maxCoeff() / largest_number - 1e-12));
  if (plan.sweeps > 0) plan.number /= plan.sweeps;
  return plan;
}

Smoothing::Smoothing(const cfd::Decomposition& decomposition, const cfd::WallGeometry& walls)
    : decomposition_(decomposition), inverse_open_fraction_(decomposition.block().size) {
  set_walls(walls);
}

void Smoothing::set_walls(const cfd::WallGeometry& walls) {
  open_fraction_ = connected_open_fraction(decomposition_, walls);
  const cfd::Index3 size = decomposition_.block().size;
  cfd::for_each_cell(size, [&](int i, int j, int k) {
    const double open = open_fraction_(i, j, k);
    inverse_open_fraction_(i, j, k) = open > 0 ? 1.0 / open : 0.0;
  });
  for (int d = 0; d < 3; ++d) {
    passage_[d] = cfd::Field(size);
    cfd::Index3 faces = size;
    ++faces[d];
    const std::ptrdiff_t below = open_fraction_.stride(d);
    cfd::for_each_cell(faces, [&](int i, int j, int k) {
      const std::ptrdiff_t n = open_fraction_.index(i, j, k);
      if (walls.open_area[d][n] > 0) {
        passage_[d][n] = std::min(open_fraction_[n], open_fraction_[n - below]);
      }
    });
  }
  conductance_ = passage_;
  set_plan(plan_);
}

void Smoothing::set_plan(const SmoothingPlan& plan) {
  plan_ = plan;
  for (int d = 0; d < 3; ++d) {
    for (std::size_t n = 0; n < passage_[d].count(); ++n) {
      conductance_[d][n] = plan.number[d] * passage_[d][n];
    }
  }
}

template <int components>
void Smoothing::sweep(CellArray<components>& cells, const cfd::IndexBox& box) {
  const std::ptrdiff_t sx = open_fraction_.stride(0), sy = open_fraction_.stride(1),
                       sz = open_fraction_.stride(2);
  CellArray<components>& scratch = std::get<CellArray<components>>(scratch_);
  const double *__restrict cx = conductance_[0].data(), *__restrict cy = conductance_[1].data(),
               *__restrict cz = conductance_[2].data(),
               *__restrict inverse = inverse_open_fraction_.data();
  const auto* __restrict f = cells.data();
  auto* __restrict out = scratch.data();
  cfd::for_each_row(box, open_fraction_, [=](std::ptrdiff_t row, int length) {
    for (std::ptrdiff_t n = row; n < row + length; ++n) {
#pragma omp simd
      for (int m = 0; m < stored_components<components>; ++m) {
        const double inflow =
            cx[n] * (f[n - sx][m] - f[n][m]) + cx[n + sx] * (f[n + sx][m] - f[n][m]) +
            cy[n] * (f[n - sy][m] - f[n][m]) + cy[n + sy] * (f[n + sy][m] - f[n][m]) +
            cz[n] * (f[n - sz][m] - f[n][m]) + cz[n + sz] * (f[n + sz][m] - f[n][m]);
        out[n][m] = f[n][m] + inverse[n] * inflow;
      }
    }
  });
  std::swap(cells, scratch);
}

template <int components>
void Smoothing::apply(CellArray<components>& cells, const CellRange& range) {
  if (plan_.sweeps == 0) return;
  CellArray<components>& scratch = std::get<CellArray<components>>(scratch_);
  scratch.resize(cells.size());
  clear<components>(scratch, range.with_ring, open_fraction_);
  for (int s = 0; s < plan_.sweeps; ++s) {
    fill_face_ghosts<components>(decomposition_, cells);
    sweep<components>(cells, range.cells);
  }
}

#define GASGRAIN_INSTANTIATE(components) \
  template void Smoothing::apply<components>(CellArray<components>&, const CellRange&);
GASGRAIN_FOR_COMPONENTS(GASGRAIN_INSTANTIATE)
#undef GASGRAIN_INSTANTIATE

}  // namespace gasgrain::coupling
