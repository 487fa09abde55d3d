// What the solvers of hypre have in common; the solvers are in hypre_struct.cpp and
// hypre_boomeramg.cpp.
//
// - Their cycles stall on a singular matrix, so one cell of every region without outlet gets a
//   small extra diagonal. With a right-hand side of zero sum the solution has p = 0 there and
//   satisfies the original equations exactly; the extra diagonal fixes the constant, nothing else.
//   The first guess is shifted to p = 0 there, else the shift alone would look like an error.
// - The matrix is set up again only when a coefficient changed.
// - The recursive residual drifts from the true one; the true one decides, and the iteration is
//   started again from where it stands while it is too large.
#include "cfd/pressure_hypre.hpp"

#include <vector>

#include "cfd/gas_regions.hpp"
#include "cfd/halo_exchange.hpp"
#include "cfd/hypre_backend.hpp"
#include "cfd/loops.hpp"
#include "cfd/pressure_operator.hpp"

namespace gasgrain::cfd {

namespace {

constexpr int restarts = 5;
constexpr double pin = 1e-2;  // extra diagonal of a pinned cell, relative

class HypreSolver final : public PressureSolver {
 public:
  HypreSolver(const Decomposition& decomposition, std::unique_ptr<HypreBackend> backend)
      : decomposition_(decomposition),
        backend_(std::move(backend)),
        diagonal_(decomposition.block().size) {}

  PressureReport solve(const PressureSystem& system, double tolerance, int max_iterations,
                       Field& pressure) override;

 private:
  bool find_regions(const PressureSystem& system);
  void set_matrix(const PressureSystem& system);
  bool is_pinned(int region, const Index3& local_cell) const;
  void shift_to_pins(Field& pressure) const;

  const Decomposition& decomposition_;
  std::unique_ptr<HypreBackend> backend_;
  std::vector<char> joined_;          // which faces are open, to notice when regions change
  std::vector<double> coefficients_;  // likewise of the matrix
  GasRegions regions_;
  Field diagonal_;
};

// Returns whether the open faces changed.
bool HypreSolver::find_regions(const PressureSystem& system) {
  std::vector<char> joined;
  for (const Field& t : system.transmissibility) {
    for_each_cell(t.size(), [&](int i, int j, int k) { joined.push_back(t(i, j, k) > 0.0); });
  }
  for_each_cell(system.diagonal.size(),
                [&](int i, int j, int k) { joined.push_back(system.diagonal(i, j, k) > 0.0); });
  const bool changed = joined != joined_;
  if (max_over_ranks(decomposition_, changed ? 1.0 : 0.0) == 0.0) return false;
  joined_ = std::move(joined);
  regions_ = find_gas_regions(decomposition_, system.transmissibility, system.diagonal);
  return true;
}

bool HypreSolver::is_pinned(int region, const Index3& local_cell) const {
  if (region == GasRegions::none || regions_.regions[region].has_outlet) return false;
  const Index3& lower = decomposition_.block().lower;
  return regions_.regions[region].first_cell ==
         Index3{local_cell[0] + lower[0], local_cell[1] + lower[1], local_cell[2] + lower[2]};
}

void HypreSolver::set_matrix(const PressureSystem& system) {
  const bool pattern_changed = find_regions(system);
  std::vector<double> coefficients;
  coefficients.reserve(coefficients_.size());
  std::size_t m = 0;
  for_each_cell(diagonal_.size(), [&](int i, int j, int k) {
    const std::ptrdiff_t n = diagonal_.index(i, j, k);
    double sum = system.diagonal[n];
    for (const Field& t : system.transmissibility) {
      const std::size_t d = &t - system.transmissibility.data();
      sum += t[n] + t[n + t.stride(static_cast<int>(d))];
      coefficients.push_back(t[n]);
    }
    const int region = regions_.region_of_cell[m++];
    if (region == GasRegions::none) sum = 1.0;
    diagonal_[n] = is_pinned(region, {i, j, k}) ? sum * (1.0 + pin) : sum;
    coefficients.push_back(diagonal_[n]);
  });
  const bool changed = coefficients != coefficients_;
  if (max_over_ranks(decomposition_, changed ? 1.0 : 0.0) == 0.0) return;
  coefficients_ = std::move(coefficients);
  backend_->set_matrix({system.transmissibility, diagonal_}, pattern_changed);
}

void HypreSolver::shift_to_pins(Field& pressure) const {
  if (!regions_.any_singular()) return;
  std::vector<double> shift(regions_.regions.size(), 0.0);
  std::size_t m = 0;
  for_each_cell(pressure.size(), [&](int i, int j, int k) {
    const int region = regions_.region_of_cell[m++];
    if (is_pinned(region, {i, j, k})) shift[region] = pressure(i, j, k);
  });
  sum_over_ranks(decomposition_, shift);
  m = 0;
  for_each_cell(pressure.size(), [&](int i, int j, int k) {
    const int region = regions_.region_of_cell[m++];
    if (region != GasRegions::none) pressure(i, j, k) -= shift[region];
  });
}

PressureReport HypreSolver::solve(const PressureSystem& system, double tolerance,
                                  int max_iterations, Field& pressure) {
  set_matrix(system);
  clear_isolated_cells(pressure, system);
  PressureReport report;
  const double norm = right_hand_side_norm(decomposition_, system);
  if (norm == 0.0) {
    pressure.fill(0.0);
    return report;
  }
  shift_to_pins(pressure);
  report.residual = residual_norm(decomposition_, system, pressure) / norm;
  for (int attempt = 0; attempt < restarts && report.residual > tolerance; ++attempt) {
    const int left = max_iterations - report.iterations;
    if (left <= 0) break;
    report.iterations += backend_->solve(pressure, system.right_hand_side, tolerance, left);
    report.residual = residual_norm(decomposition_, system, pressure) / norm;
  }
  report.converged = report.residual <= tolerance;
  return report;
}

}  // namespace

std::unique_ptr<PressureSolver> make_hypre_solver(const Decomposition& decomposition,
                                                  PressureMethod method) {
  return std::make_unique<HypreSolver>(decomposition,
                                       method == PressureMethod::hypre_boomeramg
                                           ? make_hypre_boomeramg(decomposition)
                                           : make_hypre_struct(decomposition, method));
}

}  // namespace gasgrain::cfd
