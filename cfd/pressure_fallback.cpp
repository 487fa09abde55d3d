// The choice of a method, and the watch over it: when it misses its tolerance the same system is
// solved again, from the same first guess, by a method of another kind. A residual above the
// tolerance passes only when it is round-off of its own evaluation and small.
#include <cstdio>

#include "cfd/pressure_hypre.hpp"
#include "cfd/pressure_multigrid.hpp"
#include "cfd/pressure_operator.hpp"

namespace gasgrain::cfd {

namespace {

constexpr double round_off_margin = 8.0;    // in units of the evaluation's own round-off
constexpr double largest_round_off = 1e-9;  // a diverged pressure is no excuse for a residual

PressureMethod method_of(PressureFallback fallback) {
  return fallback == PressureFallback::hypre_pfmg ? PressureMethod::hypre_pfmg
                                                  : PressureMethod::hypre_boomeramg;
}

class WatchedSolver final : public PressureSolver {
 public:
  WatchedSolver(const Decomposition& decomposition, PressureMethod method,
                PressureFallback fallback)
      : decomposition_(decomposition),
        first_(make_pressure_solver(decomposition, method)),
        fallback_(fallback) {}

  PressureReport solve(const PressureSystem& system, double tolerance, int max_iterations,
                       Field& pressure) override;

 private:
  bool is_round_off(const PressureReport& report, const PressureSystem& system,
                    const Field& pressure) const;

  void warn(const PressureReport& report, double tolerance) const;

  const Decomposition& decomposition_;
  std::unique_ptr<PressureSolver> first_, second_;  // second_ is made when it is needed
  PressureFallback fallback_;
  Field first_guess_;
};

bool WatchedSolver::is_round_off(const PressureReport& report, const PressureSystem& system,
                                 const Field& pressure) const {
  if (!(report.residual <= largest_round_off)) return false;
  const double norm = right_hand_side_norm(decomposition_, system);
  const double round_off = residual_round_off(decomposition_, system, pressure);
  return report.residual * norm <= round_off_margin * round_off;
}

// Once per run; the reports count every time.
void WatchedSolver::warn(const PressureReport& report, double tolerance) const {
  if (decomposition_.rank() != 0) return;
  std::fprintf(stderr,
               "warning: numerics.pressure_solver left a residual of %.3g after %d iterations "
               "(tolerance %.3g); numerics.pressure_fallback takes over whenever that happens\n",
               report.residual, report.iterations, tolerance);
}

PressureReport WatchedSolver::solve(const PressureSystem& system, double tolerance,
                                    int max_iterations, Field& pressure) {
  if (fallback_ != PressureFallback::none) first_guess_ = pressure;
  PressureReport report = first_->solve(system, tolerance, max_iterations, pressure);
  report.converged = report.converged || is_round_off(report, system, pressure);
  if (report.converged || fallback_ == PressureFallback::none) return report;
  if (!second_) {
    second_ = make_pressure_solver(decomposition_, method_of(fallback_));
    warn(report, tolerance);
  }
  pressure = first_guess_;
  PressureReport retry = second_->solve(system, tolerance, fallback_iterations, pressure);
  retry.converged = retry.converged || is_round_off(retry, system, pressure);
  retry.iterations += report.iterations;
  retry.fallbacks = 1;
  return retry;
}

}  // namespace

std::unique_ptr<PressureSolver> make_pressure_solver(const Decomposition& decomposition,
                                                     PressureMethod method) {
  return method == PressureMethod::multigrid ? make_multigrid_solver(decomposition)
                                             : make_hypre_solver(decomposition, method);
}

std::unique_ptr<PressureSolver> make_pressure_solver(const Decomposition& decomposition,
                                                     PressureMethod method,
                                                     PressureFallback fallback) {
  return std::make_unique<WatchedSolver>(decomposition, method, fallback);
}

}  // namespace gasgrain::cfd
