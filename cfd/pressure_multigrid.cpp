// Conjugate gradients in double precision, preconditioned by one multigrid cycle in single
// precision.
//
// The flexible (Polak-Ribiere) form of beta keeps the iteration sound although rounding in the
// cycle makes the preconditioner slightly nonlinear (Notay, SIAM J. Sci. Comput. 22 (2000) 1444).
// The recursive residual drifts from the true one, so the true residual is computed at the end and
// the iteration goes on from there when it misses the tolerance.
//
// Assumes a right-hand side without mean in every region that has no outlet; leaves the constant of
// such a region at what the first guess had. Rounding gives the residual a mean there, for which no
// solution exists and which the coarsest level would magnify: it is removed in every iteration.
#include <cmath>
#include <vector>

#include "cfd/gas_regions.hpp"
#include "cfd/halo_exchange.hpp"
#include "cfd/multigrid.hpp"
#include "cfd/pressure_solver.hpp"

namespace gasgrain::cfd {

namespace {

constexpr int restarts = 5;  // from the true residual

class MultigridSolver final : public PressureSolver {
 public:
  explicit MultigridSolver(const Decomposition& decomposition)
      : decomposition_(decomposition),
        multigrid_(decomposition),
        size_(decomposition.block().size),
        residual_(size_),
        previous_residual_(size_),
        preconditioned_(size_),
        direction_(size_),
        image_(size_) {}

  PressureReport solve(const PressureSystem& system, double tolerance, int max_iterations,
                       Field& pressure) override;

 private:
  // f(n) for the storage index n of every owned cell.
  template <class F>
  void for_cells(F f) const;
  // Sum of f(n) over the owned cells of all ranks.
  template <class F>
  double sum_cells(F f) const;
  // image = A field; returns field . image. Fills the ghosts of `field`.
  double apply(const PressureSystem& system, Field& field, Field& image) const;
  // residual = b - A p; returns its squared norm.
  double compute_residual(const PressureSystem& system, Field& pressure);
  // Removes the mean of the residual from regions without outlet.
  void remove_means(const PressureSystem& system);
  int iterate(const PressureSystem& system, double target, int max_iterations, double squared,
              Field& pressure);
  void clear_isolated_cells(const PressureSystem& system, Field& pressure) const;

  const Decomposition& decomposition_;
  Multigrid multigrid_;
  Index3 size_;
  Field residual_, previous_residual_, preconditioned_, direction_, image_;
};

template <class F>
void MultigridSolver::for_cells(F f) const {
  for (int k = 0; k < size_[2]; ++k)
    for (int j = 0; j < size_[1]; ++j) {
      const std::ptrdiff_t row = residual_.index(0, j, k);
      for (std::ptrdiff_t n = row; n < row + size_[0]; ++n) f(n);
    }
}

template <class F>
double MultigridSolver::sum_cells(F f) const {
  double sum = 0;
  for_cells([&](std::ptrdiff_t n) { sum += f(n); });
  return sum_over_ranks(decomposition_, sum);
}

double MultigridSolver::apply(const PressureSystem& system, Field& field, Field& image) const {
  fill_ghosts(decomposition_, field);
  const double* __restrict tx = system.transmissibility[0].data();
  const double* __restrict ty = system.transmissibility[1].data();
  const double* __restrict tz = system.transmissibility[2].data();
  const double* __restrict diagonal = system.diagonal.data();
  const double* __restrict x = field.data();
  double* __restrict y = image.data();
  const std::ptrdiff_t sy = field.stride(1);
  const std::ptrdiff_t sz = field.stride(2);
  return sum_cells([=](std::ptrdiff_t n) {
    y[n] = diagonal[n] * x[n] + tx[n] * (x[n] - x[n - 1]) + tx[n + 1] * (x[n] - x[n + 1]) +
           ty[n] * (x[n] - x[n - sy]) + ty[n + sy] * (x[n] - x[n + sy]) +
           tz[n] * (x[n] - x[n - sz]) + tz[n + sz] * (x[n] - x[n + sz]);
    return x[n] * y[n];
  });
}

double MultigridSolver::compute_residual(const PressureSystem& system, Field& pressure) {
  apply(system, pressure, image_);
  return sum_cells([&](std::ptrdiff_t n) {
    residual_[n] = system.right_hand_side[n] - image_[n];
    return residual_[n] * residual_[n];
  });
}

void MultigridSolver::remove_means(const PressureSystem& system) {
  std::vector<double> mean = sum_per_region(decomposition_, *system.regions, residual_);
  for (std::size_t r = 0; r < mean.size(); ++r) {
    const GasRegion& region = system.regions->regions[r];
    mean[r] = region.has_outlet ? 0.0 : mean[r] / region.cells;
  }
  auto region = system.regions->region_of_cell.begin();
  for_cells([&](std::ptrdiff_t n) {
    if (*region != GasRegions::none) residual_[n] -= mean[*region];
    ++region;
  });
}

int MultigridSolver::iterate(const PressureSystem& system, double target, int max_iterations,
                             double squared, Field& pressure) {
  const bool singular = system.regions && system.regions->any_singular();
  if (singular) remove_means(system);
  double old_product = 0;
  int iterations = 0;
  while (squared > target * target && iterations < max_iterations) {
    multigrid_.apply(residual_, 1 / std::sqrt(squared), preconditioned_);
    double change = 0;
    const double product =
        sum_cells([&](std::ptrdiff_t n) { return preconditioned_[n] * residual_[n]; });
    if (iterations > 0) {
      change =
          sum_cells([&](std::ptrdiff_t n) { return preconditioned_[n] * previous_residual_[n]; });
    }
    const double beta = iterations > 0 ? (product - change) / old_product : 0.0;
    old_product = product;
    for_cells([&](std::ptrdiff_t n) { direction_[n] = preconditioned_[n] + beta * direction_[n]; });
    const double curvature = apply(system, direction_, image_);
    if (!(curvature > 0)) break;  // nothing left to gain in this precision
    const double alpha = product / curvature;
    squared = sum_cells([&](std::ptrdiff_t n) {
      previous_residual_[n] = residual_[n];
      pressure[n] += alpha * direction_[n];
      residual_[n] -= alpha * image_[n];
      return residual_[n] * residual_[n];
    });
    if (singular) remove_means(system);
    ++iterations;
  }
  return iterations;
}

void MultigridSolver::clear_isolated_cells(const PressureSystem& system, Field& pressure) const {
  const auto& t = system.transmissibility;
  for_cells([&](std::ptrdiff_t n) {
    double sum = system.diagonal[n];
    for (int d = 0; d < 3; ++d) sum += t[d][n] + t[d][n + t[d].stride(d)];
    if (sum == 0) pressure[n] = 0;
  });
}

PressureReport MultigridSolver::solve(const PressureSystem& system, double tolerance,
                                      int max_iterations, Field& pressure) {
  multigrid_.set_coefficients(system);
  clear_isolated_cells(system, pressure);
  const double norm = std::sqrt(sum_cells(
      [&](std::ptrdiff_t n) { return system.right_hand_side[n] * system.right_hand_side[n]; }));
  PressureReport report;
  if (norm == 0) {
    pressure.fill(0.0);
    return report;
  }
  const double target = tolerance * norm;
  double squared = compute_residual(system, pressure);
  for (int attempt = 0; attempt < restarts && squared > target * target; ++attempt) {
    const int left = max_iterations - report.iterations;
    const double before = squared;
    const Field best = pressure;
    report.iterations += iterate(system, target, left, squared, pressure);
    squared = compute_residual(system, pressure);
    if (!(squared < before)) {  // round-off is all that is left
      pressure = best;
      squared = before;
      break;
    }
  }
  report.residual = std::sqrt(squared) / norm;
  fill_ghosts(decomposition_, pressure);
  return report;
}

}  // namespace

std::unique_ptr<PressureSolver> make_multigrid_solver(const Decomposition& decomposition) {
  return std::make_unique<MultigridSolver>(decomposition);
}

}  // namespace gasgrain::cfd
