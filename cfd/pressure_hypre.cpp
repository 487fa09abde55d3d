// The pressure equation by hypre: Struct conjugate gradients preconditioned by one PFMG V-cycle
// (Ashby & Falgout, Nucl. Sci. Eng. 124 (1996) 145). The only file that names hypre.
//
// - Directions of one cell are left out of hypre's grid; the matrix is stored symmetric.
// - Grid, stencil, matrix and vectors live as long as the solver. The V-cycle is set up again only
//   when a coefficient changed.
// - Coarse operators are Galerkin's, smoothed by weighted Jacobi: the cheaper seven-point coarse
//   operators with red-black Gauss-Seidel become indefinite when solid cells coarsen to a few.
// - PFMG stalls on a singular matrix, so one cell of every region without outlet gets a small extra
//   diagonal. With a right-hand side of zero sum the solution has p = 0 there and satisfies the
//   original equations exactly; the extra diagonal fixes the constant, nothing else. The mean of p
//   is set to zero afterwards.
// - The recursive residual drifts from the true one; the true one decides, and the iteration is
//   started again from where it stands while it is too large.
#include <HYPRE.h>
#include <HYPRE_struct_ls.h>

#include <cmath>
#include <vector>

#include "cfd/gas_regions.hpp"
#include "cfd/halo_exchange.hpp"
#include "cfd/loops.hpp"
#include "cfd/pressure_solver.hpp"
#include "coupling/shared/error.hpp"

namespace gasgrain::cfd {

namespace {

constexpr int restarts = 5;
constexpr double pin = 1e-2;        // extra diagonal of a pinned cell, relative
constexpr int galerkin = 0;         // PFMG coarse operator
constexpr int weighted_jacobi = 1;  // PFMG smoother, symmetric

void initialize_hypre_once() {
  static const bool done = [] {
    HYPRE_Init();
    return true;
  }();
  GASGRAIN_ASSERT(done);
}

class HypreSolver final : public PressureSolver {
 public:
  explicit HypreSolver(const Decomposition& decomposition);
  ~HypreSolver() override;
  HypreSolver(const HypreSolver&) = delete;
  HypreSolver& operator=(const HypreSolver&) = delete;

  PressureReport solve(const PressureSystem& system, double tolerance, int max_iterations,
                       Field& pressure) override;

 private:
  void create_grid();
  void find_regions(const PressureSystem& system);
  std::vector<double> matrix_values(const PressureSystem& system) const;
  void set_matrix(const PressureSystem& system);
  void create_solver();
  void destroy_solver();
  void copy_to(HYPRE_StructVector vector, const Field& field);
  void copy_from(HYPRE_StructVector vector, Field& field);
  double residual_norm(const PressureSystem& system, Field& pressure) const;
  void remove_means(Field& pressure) const;

  const Decomposition& decomposition_;
  std::vector<int> directions_;  // of the grid with more than one cell; hypre needs at least two
  std::vector<HYPRE_Int> lower_, upper_;
  std::vector<double> values_, buffer_;
  std::vector<char> joined_;  // which faces are open, to notice when regions change
  GasRegions regions_;
  HYPRE_StructGrid grid_ = nullptr;
  HYPRE_StructStencil stencil_ = nullptr;
  HYPRE_StructMatrix matrix_ = nullptr;
  HYPRE_StructVector rhs_ = nullptr, solution_ = nullptr;
  HYPRE_StructSolver solver_ = nullptr, cycle_ = nullptr;
};

HypreSolver::HypreSolver(const Decomposition& decomposition) : decomposition_(decomposition) {
  initialize_hypre_once();
  for (int d = 0; d < 3; ++d) {
    if (decomposition.grid().cells[d] > 1) directions_.push_back(d);
  }
  for (int d = 0; d < 3 && directions_.size() < 2; ++d) {
    if (decomposition.grid().cells[d] == 1) directions_.push_back(d);
  }
  create_grid();
}

void HypreSolver::create_grid() {
  const int dimensions = static_cast<int>(directions_.size());
  const Block& block = decomposition_.block();
  std::vector<HYPRE_Int> period(dimensions, 0);
  for (int m = 0; m < dimensions; ++m) {
    const int d = directions_[m], cells = decomposition_.grid().cells[d];
    lower_.push_back(block.lower[d]);
    upper_.push_back(block.lower[d] + block.size[d] - 1);
    if (decomposition_.periodic()[d] && cells > 1) period[m] = cells;
  }
  HYPRE_StructGridCreate(decomposition_.communicator(), dimensions, &grid_);
  HYPRE_StructGridSetExtents(grid_, lower_.data(), upper_.data());
  HYPRE_StructGridSetPeriodic(grid_, period.data());
  HYPRE_StructGridAssemble(grid_);
  HYPRE_StructStencilCreate(dimensions, dimensions + 1, &stencil_);
  for (int entry = 0; entry <= dimensions; ++entry) {
    std::vector<HYPRE_Int> offset(dimensions, 0);
    if (entry > 0) offset[entry - 1] = -1;
    HYPRE_StructStencilSetElement(stencil_, entry, offset.data());
  }
  HYPRE_StructMatrixCreate(decomposition_.communicator(), grid_, stencil_, &matrix_);
  HYPRE_StructMatrixSetSymmetric(matrix_, 1);
  HYPRE_StructMatrixInitialize(matrix_);
  for (HYPRE_StructVector* vector : {&rhs_, &solution_}) {
    HYPRE_StructVectorCreate(decomposition_.communicator(), grid_, vector);
    HYPRE_StructVectorInitialize(*vector);
  }
}

HypreSolver::~HypreSolver() {
  destroy_solver();
  HYPRE_StructVectorDestroy(solution_);
  HYPRE_StructVectorDestroy(rhs_);
  HYPRE_StructMatrixDestroy(matrix_);
  HYPRE_StructStencilDestroy(stencil_);
  HYPRE_StructGridDestroy(grid_);
}

void HypreSolver::find_regions(const PressureSystem& system) {
  std::vector<char> joined;
  for (const Field& t : system.transmissibility) {
    for_each_cell(t.size(), [&](int i, int j, int k) { joined.push_back(t(i, j, k) > 0.0); });
  }
  for_each_cell(system.diagonal.size(),
                [&](int i, int j, int k) { joined.push_back(system.diagonal(i, j, k) > 0.0); });
  const bool changed = joined != joined_;
  if (max_over_ranks(decomposition_, changed ? 1.0 : 0.0) == 0.0) return;
  joined_ = std::move(joined);
  regions_ = find_gas_regions(decomposition_, system.transmissibility, system.diagonal);
}

// Diagonal and lower neighbours of every owned cell.
std::vector<double> HypreSolver::matrix_values(const PressureSystem& system) const {
  std::vector<double> values;
  values.reserve((directions_.size() + 1) * regions_.region_of_cell.size());
  const Block& block = decomposition_.block();
  std::size_t m = 0;
  for_each_cell(block.size, [&](int i, int j, int k) {
    const std::ptrdiff_t n = system.diagonal.index(i, j, k);
    double diagonal = system.diagonal[n];
    for (int d : directions_) {
      const Field& t = system.transmissibility[d];
      diagonal += t[n] + t[n + t.stride(d)];
    }
    const int region = regions_.region_of_cell[m++];
    if (region == GasRegions::none) {
      diagonal = 1.0;
    } else if (!regions_.regions[region].has_outlet &&
               regions_.regions[region].first_cell ==
                   Index3{i + block.lower[0], j + block.lower[1], k + block.lower[2]}) {
      diagonal *= 1.0 + pin;
    }
    values.push_back(diagonal);
    for (int d : directions_) values.push_back(-system.transmissibility[d][n]);
  });
  return values;
}

void HypreSolver::set_matrix(const PressureSystem& system) {
  std::vector<double> values = matrix_values(system);
  const bool changed = values != values_;
  if (max_over_ranks(decomposition_, changed ? 1.0 : 0.0) == 0.0) return;
  values_ = std::move(values);
  std::vector<HYPRE_Int> entries(directions_.size() + 1);
  for (std::size_t e = 0; e < entries.size(); ++e) entries[e] = static_cast<HYPRE_Int>(e);
  HYPRE_StructMatrixSetBoxValues(matrix_, lower_.data(), upper_.data(),
                                 static_cast<HYPRE_Int>(entries.size()), entries.data(),
                                 values_.data());
  HYPRE_StructMatrixAssemble(matrix_);
  destroy_solver();
  create_solver();
}

void HypreSolver::create_solver() {
  HYPRE_StructPFMGCreate(decomposition_.communicator(), &cycle_);
  HYPRE_StructPFMGSetMaxIter(cycle_, 1);
  HYPRE_StructPFMGSetTol(cycle_, 0.0);
  HYPRE_StructPFMGSetZeroGuess(cycle_);
  HYPRE_StructPFMGSetRAPType(cycle_, galerkin);
  HYPRE_StructPFMGSetRelaxType(cycle_, weighted_jacobi);
  HYPRE_StructPFMGSetNumPreRelax(cycle_, 1);
  HYPRE_StructPFMGSetNumPostRelax(cycle_, 1);
  HYPRE_StructPFMGSetSkipRelax(cycle_, 0);
  HYPRE_StructPCGCreate(decomposition_.communicator(), &solver_);
  HYPRE_StructPCGSetTwoNorm(solver_, 1);
  HYPRE_StructPCGSetRelChange(solver_, 0);
  HYPRE_StructPCGSetPrecond(solver_, HYPRE_StructPFMGSolve, HYPRE_StructPFMGSetup, cycle_);
  HYPRE_StructPCGSetup(solver_, matrix_, rhs_, solution_);
}

void HypreSolver::destroy_solver() {
  if (solver_) HYPRE_StructPCGDestroy(solver_);
  if (cycle_) HYPRE_StructPFMGDestroy(cycle_);
  solver_ = cycle_ = nullptr;
}

void HypreSolver::copy_to(HYPRE_StructVector vector, const Field& field) {
  buffer_.clear();
  for_each_cell(field.size(), [&](int i, int j, int k) { buffer_.push_back(field(i, j, k)); });
  HYPRE_StructVectorSetBoxValues(vector, lower_.data(), upper_.data(), buffer_.data());
  HYPRE_StructVectorAssemble(vector);
}

void HypreSolver::copy_from(HYPRE_StructVector vector, Field& field) {
  HYPRE_StructVectorGetBoxValues(vector, lower_.data(), upper_.data(), buffer_.data());
  std::size_t m = 0;
  for_each_cell(field.size(), [&](int i, int j, int k) { field(i, j, k) = buffer_[m++]; });
}

double HypreSolver::residual_norm(const PressureSystem& system, Field& pressure) const {
  fill_ghosts(decomposition_, pressure);
  double sum = 0.0;
  for_each_cell(pressure.size(), [&](int i, int j, int k) {
    const std::ptrdiff_t n = pressure.index(i, j, k);
    double residual = system.right_hand_side[n] - system.diagonal[n] * pressure[n];
    for (int d = 0; d < 3; ++d) {
      const Field& t = system.transmissibility[d];
      const std::ptrdiff_t s = t.stride(d);
      residual -= t[n] * (pressure[n] - pressure[n - s]);
      residual -= t[n + s] * (pressure[n] - pressure[n + s]);
    }
    sum += residual * residual;
  });
  return std::sqrt(sum_over_ranks(decomposition_, sum));
}

void HypreSolver::remove_means(Field& pressure) const {
  if (!regions_.any_singular()) return;
  std::vector<double> mean = sum_per_region(decomposition_, regions_, pressure);
  for (std::size_t r = 0; r < mean.size(); ++r) {
    mean[r] = regions_.regions[r].has_outlet ? 0.0 : mean[r] / regions_.regions[r].cells;
  }
  std::size_t m = 0;
  for_each_cell(pressure.size(), [&](int i, int j, int k) {
    const int region = regions_.region_of_cell[m++];
    if (region != GasRegions::none) pressure(i, j, k) -= mean[region];
  });
}

PressureReport HypreSolver::solve(const PressureSystem& system, double tolerance,
                                  int max_iterations, Field& pressure) {
  find_regions(system);
  set_matrix(system);
  double norm = 0.0;
  std::size_t m = 0;
  for_each_cell(pressure.size(), [&](int i, int j, int k) {
    norm += system.right_hand_side(i, j, k) * system.right_hand_side(i, j, k);
    if (regions_.region_of_cell[m++] == GasRegions::none) pressure(i, j, k) = 0.0;
  });
  norm = std::sqrt(sum_over_ranks(decomposition_, norm));
  PressureReport report;
  if (norm == 0.0) {
    pressure.fill(0.0);
    return report;
  }
  copy_to(rhs_, system.right_hand_side);
  report.residual = residual_norm(system, pressure) / norm;
  HYPRE_StructPCGSetTol(solver_, tolerance);
  for (int attempt = 0; attempt < restarts && report.residual > tolerance; ++attempt) {
    const int left = max_iterations - report.iterations;
    if (left <= 0) break;
    copy_to(solution_, pressure);
    HYPRE_StructPCGSetMaxIter(solver_, left);
    HYPRE_StructPCGSolve(solver_, matrix_, rhs_, solution_);
    HYPRE_Int iterations = 0;
    HYPRE_StructPCGGetNumIterations(solver_, &iterations);
    HYPRE_ClearAllErrors();  // not converged is told by the residual
    report.iterations += static_cast<int>(iterations);
    copy_from(solution_, pressure);
    remove_means(pressure);
    report.residual = residual_norm(system, pressure) / norm;
  }
  remove_means(pressure);
  fill_ghosts(decomposition_, pressure);
  return report;
}

}  // namespace

std::unique_ptr<PressureSolver> make_hypre_solver(const Decomposition& decomposition) {
  return std::make_unique<HypreSolver>(decomposition);
}

}  // namespace gasgrain::cfd
