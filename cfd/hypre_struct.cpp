// Conjugate gradients with one V-cycle of hypre's structured-grid multigrid: PFMG (Ashby &
// Falgout, Nucl. Sci. Eng. 124 (1996) 145) or SMG (Brown, Falgout, Jones, SIAM J. Sci. Comput. 21
// (2000) 1823).
//
// - Directions of one cell are left out of hypre's grid; the matrix is stored symmetric.
// - Grid, stencil, matrix and vectors live as long as the solver.
// - PFMG: with Galerkin's coarse operators and weighted Jacobi, or with seven-point coarse
//   operators and red-black Gauss-Seidel; the latter are cheaper but become indefinite when solid
//   cells coarsen to a few.
// - SMG fails in periodic directions of an odd number of cells.
#include <HYPRE.h>
#include <HYPRE_struct_ls.h>

#include <vector>

#include "cfd/hypre_backend.hpp"
#include "cfd/loops.hpp"
#include "coupling/shared/error.hpp"

namespace gasgrain::cfd {

namespace {

constexpr int galerkin = 0, seven_point = 1;       // PFMG coarse operators
constexpr int weighted_jacobi = 1, red_black = 2;  // PFMG smoothers, symmetric

class HypreStruct final : public HypreBackend {
 public:
  HypreStruct(const Decomposition& decomposition, PressureMethod method);
  ~HypreStruct() override;
  HypreStruct(const HypreStruct&) = delete;
  HypreStruct& operator=(const HypreStruct&) = delete;

  void set_matrix(const HypreMatrix& matrix, bool pattern_changed) override;
  int solve(Field& solution, const Field& right_hand_side, double tolerance,
            int max_iterations) override;

 private:
  void create_grid(const Decomposition& decomposition);
  void create_solver();
  void create_pfmg();
  void create_smg();
  void destroy_solver();
  void copy_to(HYPRE_StructVector vector, const Field& field);
  void copy_from(HYPRE_StructVector vector, Field& field);

  MPI_Comm communicator_;
  PressureMethod method_;
  std::vector<int> directions_;  // of the grid with more than one cell; hypre needs at least two
  std::vector<HYPRE_Int> lower_, upper_;
  std::vector<double> buffer_;
  HYPRE_StructGrid grid_ = nullptr;
  HYPRE_StructStencil stencil_ = nullptr;
  HYPRE_StructMatrix matrix_ = nullptr;
  HYPRE_StructVector rhs_ = nullptr, solution_ = nullptr;
  HYPRE_StructSolver solver_ = nullptr, cycle_ = nullptr;
};

HypreStruct::HypreStruct(const Decomposition& decomposition, PressureMethod method)
    : communicator_(decomposition.communicator()), method_(method) {
  initialize_hypre_once();
  for (int d = 0; d < 3; ++d) {
    if (decomposition.grid().cells[d] > 1) directions_.push_back(d);
  }
  for (int d = 0; d < 3 && directions_.size() < 2; ++d) {
    if (decomposition.grid().cells[d] == 1) directions_.push_back(d);
  }
  create_grid(decomposition);
}

void HypreStruct::create_grid(const Decomposition& decomposition) {
  const int dimensions = static_cast<int>(directions_.size());
  const Block& block = decomposition.block();
  std::vector<HYPRE_Int> period(dimensions, 0);
  for (int m = 0; m < dimensions; ++m) {
    const int d = directions_[m], cells = decomposition.grid().cells[d];
    lower_.push_back(block.lower[d]);
    upper_.push_back(block.lower[d] + block.size[d] - 1);
    if (decomposition.periodic()[d] && cells > 1) period[m] = cells;
  }
  HYPRE_StructGridCreate(communicator_, dimensions, &grid_);
  HYPRE_StructGridSetExtents(grid_, lower_.data(), upper_.data());
  HYPRE_StructGridSetPeriodic(grid_, period.data());
  HYPRE_StructGridAssemble(grid_);
  HYPRE_StructStencilCreate(dimensions, dimensions + 1, &stencil_);
  for (int entry = 0; entry <= dimensions; ++entry) {
    std::vector<HYPRE_Int> offset(dimensions, 0);
    if (entry > 0) offset[entry - 1] = -1;
    HYPRE_StructStencilSetElement(stencil_, entry, offset.data());
  }
  HYPRE_StructMatrixCreate(communicator_, grid_, stencil_, &matrix_);
  HYPRE_StructMatrixSetSymmetric(matrix_, 1);
  HYPRE_StructMatrixInitialize(matrix_);
  for (HYPRE_StructVector* vector : {&rhs_, &solution_}) {
    HYPRE_StructVectorCreate(communicator_, grid_, vector);
    HYPRE_StructVectorInitialize(*vector);
  }
}

HypreStruct::~HypreStruct() {
  destroy_solver();
  HYPRE_StructVectorDestroy(solution_);
  HYPRE_StructVectorDestroy(rhs_);
  HYPRE_StructMatrixDestroy(matrix_);
  HYPRE_StructStencilDestroy(stencil_);
  HYPRE_StructGridDestroy(grid_);
}

void HypreStruct::set_matrix(const HypreMatrix& matrix, bool /*pattern_changed*/) {
  buffer_.clear();
  for_each_cell(matrix.diagonal.size(), [&](int i, int j, int k) {
    buffer_.push_back(matrix.diagonal(i, j, k));
    for (int d : directions_) buffer_.push_back(-matrix.transmissibility[d](i, j, k));
  });
  std::vector<HYPRE_Int> entries(directions_.size() + 1);
  for (std::size_t e = 0; e < entries.size(); ++e) entries[e] = static_cast<HYPRE_Int>(e);
  HYPRE_StructMatrixSetBoxValues(matrix_, lower_.data(), upper_.data(),
                                 static_cast<HYPRE_Int>(entries.size()), entries.data(),
                                 buffer_.data());
  HYPRE_StructMatrixAssemble(matrix_);
  destroy_solver();
  create_solver();
}

void HypreStruct::create_solver() {
  HYPRE_StructPCGCreate(communicator_, &solver_);
  HYPRE_StructPCGSetTwoNorm(solver_, 1);
  HYPRE_StructPCGSetRelChange(solver_, 0);
  if (method_ == PressureMethod::hypre_smg) {
    create_smg();
  } else {
    create_pfmg();
  }
  HYPRE_StructPCGSetup(solver_, matrix_, rhs_, solution_);
}

void HypreStruct::create_pfmg() {
  const bool rap = method_ == PressureMethod::hypre_pfmg_rap;
  HYPRE_StructPFMGCreate(communicator_, &cycle_);
  HYPRE_StructPFMGSetMaxIter(cycle_, 1);
  HYPRE_StructPFMGSetTol(cycle_, 0.0);
  HYPRE_StructPFMGSetZeroGuess(cycle_);
  HYPRE_StructPFMGSetRAPType(cycle_, rap ? seven_point : galerkin);
  HYPRE_StructPFMGSetRelaxType(cycle_, rap ? red_black : weighted_jacobi);
  HYPRE_StructPFMGSetNumPreRelax(cycle_, 1);
  HYPRE_StructPFMGSetNumPostRelax(cycle_, 1);
  HYPRE_StructPFMGSetSkipRelax(cycle_, 0);
  HYPRE_StructPCGSetPrecond(solver_, HYPRE_StructPFMGSolve, HYPRE_StructPFMGSetup, cycle_);
}

void HypreStruct::create_smg() {
  HYPRE_StructSMGCreate(communicator_, &cycle_);
  HYPRE_StructSMGSetMemoryUse(cycle_, 0);
  HYPRE_StructSMGSetMaxIter(cycle_, 1);
  HYPRE_StructSMGSetTol(cycle_, 0.0);
  HYPRE_StructSMGSetZeroGuess(cycle_);
  HYPRE_StructSMGSetNumPreRelax(cycle_, 1);
  HYPRE_StructSMGSetNumPostRelax(cycle_, 1);
  HYPRE_StructPCGSetPrecond(solver_, HYPRE_StructSMGSolve, HYPRE_StructSMGSetup, cycle_);
}

void HypreStruct::destroy_solver() {
  if (solver_) HYPRE_StructPCGDestroy(solver_);
  if (cycle_ && method_ == PressureMethod::hypre_smg) HYPRE_StructSMGDestroy(cycle_);
  if (cycle_ && method_ != PressureMethod::hypre_smg) HYPRE_StructPFMGDestroy(cycle_);
  solver_ = cycle_ = nullptr;
}

void HypreStruct::copy_to(HYPRE_StructVector vector, const Field& field) {
  buffer_.clear();
  for_each_cell(field.size(), [&](int i, int j, int k) { buffer_.push_back(field(i, j, k)); });
  HYPRE_StructVectorSetBoxValues(vector, lower_.data(), upper_.data(), buffer_.data());
  HYPRE_StructVectorAssemble(vector);
}

void HypreStruct::copy_from(HYPRE_StructVector vector, Field& field) {
  HYPRE_StructVectorGetBoxValues(vector, lower_.data(), upper_.data(), buffer_.data());
  std::size_t m = 0;
  for_each_cell(field.size(), [&](int i, int j, int k) { field(i, j, k) = buffer_[m++]; });
}

int HypreStruct::solve(Field& solution, const Field& right_hand_side, double tolerance,
                       int max_iterations) {
  copy_to(rhs_, right_hand_side);
  copy_to(solution_, solution);
  HYPRE_StructPCGSetTol(solver_, tolerance);
  HYPRE_StructPCGSetMaxIter(solver_, max_iterations);
  HYPRE_StructPCGSolve(solver_, matrix_, rhs_, solution_);
  HYPRE_Int iterations = 0;
  HYPRE_StructPCGGetNumIterations(solver_, &iterations);
  HYPRE_ClearAllErrors();  // not converged is told by the residual
  copy_from(solution_, solution);
  return static_cast<int>(iterations);
}

}  // namespace

std::unique_ptr<HypreBackend> make_hypre_struct(const Decomposition& decomposition,
                                                PressureMethod method) {
  return std::make_unique<HypreStruct>(decomposition, method);
}

void initialize_hypre_once() {
  static const bool done = [] {
    HYPRE_Init();
    return true;
  }();
  GASGRAIN_ASSERT(done);
}

}  // namespace gasgrain::cfd
