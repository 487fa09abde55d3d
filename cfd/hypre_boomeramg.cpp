// Conjugate gradients with one V-cycle of hypre's algebraic multigrid BoomerAMG (Henson & Yang,
// Appl. Numer. Math. 41 (2002) 155): HMIS coarsening, extended+i interpolation of at most four
// entries, one level of aggressive coarsening, symmetric Gauss-Seidel; the settings its authors
// recommend for three-dimensional diffusion. It knows no grid, so neither solid cells nor thin
// domains trouble it: the method to fall back on.
//
// Rows are numbered rank by rank, x fastest. Closed faces leave no entry. In a periodic direction
// of two cells both faces lead to the same neighbour: their entries are added.
#include <HYPRE.h>
#include <HYPRE_IJ_mv.h>
#include <HYPRE_krylov.h>
#include <HYPRE_parcsr_ls.h>

#include <algorithm>
#include <vector>

#include "cfd/halo_exchange.hpp"
#include "cfd/hypre_backend.hpp"
#include "cfd/loops.hpp"

namespace gasgrain::cfd {

namespace {

constexpr int hmis = 10, extended_interpolation = 6, symmetric_gauss_seidel = 6;
constexpr int interpolation_entries = 4, aggressive_levels = 1;
constexpr double strong_threshold = 0.25;

class HypreBoomerAMG final : public HypreBackend {
 public:
  explicit HypreBoomerAMG(const Decomposition& decomposition);
  ~HypreBoomerAMG() override;
  HypreBoomerAMG(const HypreBoomerAMG&) = delete;
  HypreBoomerAMG& operator=(const HypreBoomerAMG&) = delete;

  void set_matrix(const HypreMatrix& matrix, bool pattern_changed) override;
  int solve(Field& solution, const Field& right_hand_side, double tolerance,
            int max_iterations) override;

 private:
  void number_rows(const Decomposition& decomposition);
  void create_vectors();
  void create_matrix();
  void collect_rows(const HypreMatrix& matrix);
  void create_solver();
  void destroy_solver();
  void copy_to(HYPRE_IJVector vector, const Field& field);

  MPI_Comm communicator_;
  Field number_;  // of the row of every cell, ghosts filled; exact up to 2^53
  HYPRE_BigInt first_ = 0, last_ = -1;
  std::vector<HYPRE_BigInt> rows_, columns_;  // of this rank
  std::vector<HYPRE_Int> entries_;            // per row
  std::vector<double> values_, buffer_;
  HYPRE_IJMatrix matrix_ = nullptr;
  HYPRE_IJVector rhs_ = nullptr, solution_ = nullptr;
  HYPRE_Solver solver_ = nullptr, cycle_ = nullptr;
};

HypreBoomerAMG::HypreBoomerAMG(const Decomposition& decomposition)
    : communicator_(decomposition.communicator()), number_(decomposition.block().size) {
  initialize_hypre_once();
  number_rows(decomposition);
  create_vectors();
}

void HypreBoomerAMG::number_rows(const Decomposition& decomposition) {
  const Index3& size = number_.size();
  const long own = long(size[0]) * size[1] * size[2];
  long before = 0;
  MPI_Exscan(&own, &before, 1, MPI_LONG, MPI_SUM, communicator_);
  if (decomposition.rank() == 0) before = 0;
  first_ = static_cast<HYPRE_BigInt>(before);
  last_ = static_cast<HYPRE_BigInt>(before + own - 1);
  for (HYPRE_BigInt row = first_; row <= last_; ++row) rows_.push_back(row);
  auto next = rows_.begin();
  for_each_cell(size, [&](int i, int j, int k) { number_(i, j, k) = double(*next++); });
  fill_ghosts(decomposition, number_);
}

void HypreBoomerAMG::create_vectors() {
  for (HYPRE_IJVector* vector : {&rhs_, &solution_}) {
    HYPRE_IJVectorCreate(communicator_, first_, last_, vector);
    HYPRE_IJVectorSetObjectType(*vector, HYPRE_PARCSR);
    HYPRE_IJVectorInitialize(*vector);
    HYPRE_IJVectorAssemble(*vector);
  }
}

HypreBoomerAMG::~HypreBoomerAMG() {
  destroy_solver();
  if (matrix_) HYPRE_IJMatrixDestroy(matrix_);
  HYPRE_IJVectorDestroy(solution_);
  HYPRE_IJVectorDestroy(rhs_);
}

void HypreBoomerAMG::collect_rows(const HypreMatrix& matrix) {
  entries_.clear();
  columns_.clear();
  values_.clear();
  for_each_cell(number_.size(), [&](int i, int j, int k) {
    const std::ptrdiff_t n = number_.index(i, j, k);
    const std::size_t start = columns_.size();
    columns_.push_back(static_cast<HYPRE_BigInt>(number_[n]));
    values_.push_back(matrix.diagonal[n]);
    for (int d = 0; d < 3; ++d) {
      const std::ptrdiff_t s = number_.stride(d);
      for (const std::ptrdiff_t side : {std::ptrdiff_t{0}, s}) {
        const double coefficient = matrix.transmissibility[d][n + side];
        if (coefficient == 0.0) continue;
        const auto other = static_cast<HYPRE_BigInt>(number_[side ? n + s : n - s]);
        const auto known = std::find(columns_.begin() + start, columns_.end(), other);
        if (known == columns_.end()) {
          columns_.push_back(other);
          values_.push_back(-coefficient);
        } else {
          values_[known - columns_.begin()] -= coefficient;
        }
      }
    }
    entries_.push_back(static_cast<HYPRE_Int>(columns_.size() - start));
  });
}

void HypreBoomerAMG::create_matrix() {
  if (matrix_) HYPRE_IJMatrixDestroy(matrix_);
  HYPRE_IJMatrixCreate(communicator_, first_, last_, first_, last_, &matrix_);
  HYPRE_IJMatrixSetObjectType(matrix_, HYPRE_PARCSR);
  HYPRE_IJMatrixSetRowSizes(matrix_, entries_.data());
}

void HypreBoomerAMG::set_matrix(const HypreMatrix& matrix, bool pattern_changed) {
  collect_rows(matrix);
  if (pattern_changed) create_matrix();
  HYPRE_IJMatrixInitialize(matrix_);
  HYPRE_IJMatrixSetValues(matrix_, static_cast<HYPRE_Int>(rows_.size()), entries_.data(),
                          rows_.data(), columns_.data(), values_.data());
  HYPRE_IJMatrixAssemble(matrix_);
  destroy_solver();
  create_solver();
}

template <class Object, class Handle, class Get>
Object object_of(Handle handle, Get get) {
  void* object = nullptr;
  get(handle, &object);
  return static_cast<Object>(object);
}

HYPRE_ParVector vector_of(HYPRE_IJVector vector) {
  return object_of<HYPRE_ParVector>(vector, HYPRE_IJVectorGetObject);
}

HYPRE_ParCSRMatrix matrix_of(HYPRE_IJMatrix matrix) {
  return object_of<HYPRE_ParCSRMatrix>(matrix, HYPRE_IJMatrixGetObject);
}

void HypreBoomerAMG::create_solver() {
  HYPRE_BoomerAMGCreate(&cycle_);
  HYPRE_BoomerAMGSetCoarsenType(cycle_, hmis);
  HYPRE_BoomerAMGSetInterpType(cycle_, extended_interpolation);
  HYPRE_BoomerAMGSetPMaxElmts(cycle_, interpolation_entries);
  HYPRE_BoomerAMGSetAggNumLevels(cycle_, aggressive_levels);
  HYPRE_BoomerAMGSetStrongThreshold(cycle_, strong_threshold);
  HYPRE_BoomerAMGSetRelaxType(cycle_, symmetric_gauss_seidel);
  HYPRE_BoomerAMGSetNumSweeps(cycle_, 1);
  HYPRE_BoomerAMGSetTol(cycle_, 0.0);
  HYPRE_BoomerAMGSetMaxIter(cycle_, 1);
  HYPRE_ParCSRPCGCreate(communicator_, &solver_);
  HYPRE_PCGSetTwoNorm(solver_, 1);
  HYPRE_PCGSetRelChange(solver_, 0);
  HYPRE_PCGSetPrecond(solver_, reinterpret_cast<HYPRE_PtrToSolverFcn>(HYPRE_BoomerAMGSolve),
                      reinterpret_cast<HYPRE_PtrToSolverFcn>(HYPRE_BoomerAMGSetup), cycle_);
  HYPRE_ParCSRPCGSetup(solver_, matrix_of(matrix_), vector_of(rhs_), vector_of(solution_));
}

void HypreBoomerAMG::destroy_solver() {
  if (solver_) HYPRE_ParCSRPCGDestroy(solver_);
  if (cycle_) HYPRE_BoomerAMGDestroy(cycle_);
  solver_ = cycle_ = nullptr;
}

void HypreBoomerAMG::copy_to(HYPRE_IJVector vector, const Field& field) {
  buffer_.clear();
  for_each_cell(field.size(), [&](int i, int j, int k) { buffer_.push_back(field(i, j, k)); });
  HYPRE_IJVectorInitialize(vector);
  HYPRE_IJVectorSetValues(vector, static_cast<HYPRE_Int>(rows_.size()), rows_.data(),
                          buffer_.data());
  HYPRE_IJVectorAssemble(vector);
}

int HypreBoomerAMG::solve(Field& solution, const Field& right_hand_side, double tolerance,
                          int max_iterations) {
  copy_to(rhs_, right_hand_side);
  copy_to(solution_, solution);
  HYPRE_PCGSetTol(solver_, tolerance);
  HYPRE_PCGSetMaxIter(solver_, max_iterations);
  HYPRE_ParCSRPCGSolve(solver_, matrix_of(matrix_), vector_of(rhs_), vector_of(solution_));
  HYPRE_Int iterations = 0;
  HYPRE_PCGGetNumIterations(solver_, &iterations);
  HYPRE_ClearAllErrors();  // not converged is told by the residual
  HYPRE_IJVectorGetValues(solution_, static_cast<HYPRE_Int>(rows_.size()), rows_.data(),
                          buffer_.data());
  auto next = buffer_.begin();
  for_each_cell(solution.size(), [&](int i, int j, int k) { solution(i, j, k) = *next++; });
  return static_cast<int>(iterations);
}

}  // namespace

std::unique_ptr<HypreBackend> make_hypre_boomeramg(const Decomposition& decomposition) {
  return std::make_unique<HypreBoomerAMG>(decomposition);
}

}  // namespace gasgrain::cfd
