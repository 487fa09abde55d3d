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
#include "cfd/pressure_multigrid.hpp"

#include <cmath>
#include <vector>

#include "cfd/gas_regions.hpp"
#include "cfd/halo_exchange.hpp"
#include "cfd/loops.hpp"
#include "cfd/multigrid.hpp"
#include "cfd/pressure_operator.hpp"

namespace gasgrain::cfd {

namespace {

constexpr int restarts = 5;  // from the true residual

class MultigridSolver final : public PressureSolver {
 public:
  explicit MultigridSolver(const Decomposition& decomposition)
      : decomposition_(decomposition), multigrid_(decomposition) {
    for (Field* field : {&residual_, &preconditioned_, &direction_, &image_}) {
      *field = Field(decomposition.block().size);
    }
  }

  PressureReport solve(const PressureSystem& system, double tolerance, int max_iterations,
                       Field& pressure) override;

 private:
  // Squared 2-norms over all ranks.
  struct Norms {
    double residual, right_hand_side;
  };
  // residual = b - A p. Fills the ghosts of p.
  Norms compute_residual(const PressureSystem& system, Field& pressure);
  // Removes the mean of the residual from regions without outlet.
  void remove_means(const PressureSystem& system);
  int iterate(const PressureSystem& system, double target, int max_iterations, double squared,
              Field& pressure);
  // direction = M^-1 residual + beta * direction; returns direction . residual. `alpha` is that of
  // the iteration before, 0 in the first.
  double next_direction(double squared, double alpha);
  // Step by alpha; returns the squared norm of the new residual.
  double step(double alpha, Field& pressure);

  const Decomposition& decomposition_;
  Multigrid multigrid_;
  Field residual_, preconditioned_, direction_, image_;
  Field best_;
  double old_product_ = 0.0;  // of the preconditioned residual and the residual
  std::vector<double> mean_;  // per region
};

MultigridSolver::Norms MultigridSolver::compute_residual(const PressureSystem& system,
                                                         Field& pressure) {
  fill_ghosts(decomposition_, pressure);
  cfd::apply(image_, system, pressure);
  const double* b = system.right_hand_side.data();
  const double* image = image_.data();
  double* r = residual_.data();
  double norms[] = {sum_cells(residual_,
                              [=](std::ptrdiff_t n) {
                                r[n] = b[n] - image[n];
                                return r[n] * r[n];
                              }),
                    sum_cells(residual_, [=](std::ptrdiff_t n) { return b[n] * b[n]; })};
  sum_over_ranks(decomposition_, norms);
  return {norms[0], norms[1]};
}

void MultigridSolver::remove_means(const PressureSystem& system) {
  means_of_singular_regions(mean_, decomposition_, *system.regions, residual_);
  subtract_per_region(residual_, *system.regions, mean_);
}

double MultigridSolver::next_direction(double squared, double alpha) {
  multigrid_.apply(residual_, 1 / std::sqrt(squared), preconditioned_);
  const double* z = preconditioned_.data();
  const double* r = residual_.data();
  const double* image = image_.data();
  double* p = direction_.data();
  // r - r_old = -alpha image, so that z . (r - r_old) needs no copy of the old residual
  double sums[] = {
      sum_cells(residual_, [=](std::ptrdiff_t n) { return z[n] * r[n]; }),
      alpha != 0 ? sum_cells(residual_, [=](std::ptrdiff_t n) { return z[n] * image[n]; }) : 0.0};
  sum_over_ranks(decomposition_, sums);
  const double beta = alpha != 0 ? -alpha * sums[1] / old_product_ : 0.0;
  for_cells(residual_, [=](std::ptrdiff_t n) { p[n] = z[n] + beta * p[n]; });
  return old_product_ = sums[0];
}

double MultigridSolver::step(double alpha, Field& pressure) {
  const double* p = direction_.data();
  const double* image = image_.data();
  double* x = pressure.data();
  double* r = residual_.data();
  return sum_over_ranks(decomposition_, sum_cells(residual_, [=](std::ptrdiff_t n) {
                          x[n] += alpha * p[n];
                          r[n] -= alpha * image[n];
                          return r[n] * r[n];
                        }));
}

int MultigridSolver::iterate(const PressureSystem& system, double target, int max_iterations,
                             double squared, Field& pressure) {
  const bool singular = system.regions && system.regions->any_singular();
  if (singular) remove_means(system);
  double alpha = 0;
  int iterations = 0;
  while (squared > target * target && iterations < max_iterations) {
    const double product = next_direction(squared, alpha);
    fill_ghosts(decomposition_, direction_);
    const double curvature = sum_over_ranks(decomposition_, cfd::apply(image_, system, direction_));
    if (!(curvature > 0)) break;  // nothing left to gain in this precision
    alpha = product / curvature;
    squared = step(alpha, pressure);
    if (singular) remove_means(system);
    ++iterations;
  }
  return iterations;
}

PressureReport MultigridSolver::solve(const PressureSystem& system, double tolerance,
                                      int max_iterations, Field& pressure) {
  multigrid_.set_coefficients(system);
  clear_isolated_cells(pressure, system);
  PressureReport report;
  auto [squared, norm] = compute_residual(system, pressure);
  if (norm == 0) {
    pressure.fill(0.0);
    return report;
  }
  const double target = tolerance * std::sqrt(norm);
  for (int attempt = 0; attempt < restarts && squared > target * target; ++attempt) {
    const int left = max_iterations - report.iterations;
    const double before = squared;
    best_ = pressure;
    report.iterations += iterate(system, target, left, squared, pressure);
    squared = compute_residual(system, pressure).residual;
    if (!(squared < before)) {  // round-off is all that is left
      pressure = best_;
      squared = before;
      break;
    }
  }
  report.residual = std::sqrt(squared / norm);
  report.converged = report.residual <= tolerance;
  return report;
}

}  // namespace

std::unique_ptr<PressureSolver> make_multigrid_solver(const Decomposition& decomposition) {
  return std::make_unique<MultigridSolver>(decomposition);
}

}  // namespace gasgrain::cfd
