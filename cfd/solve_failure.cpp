#include "cfd/solve_failure.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cfd/gas_solver.hpp"
#include "cfd/halo_exchange.hpp"
#include "cfd/loops.hpp"
#include "coupling/shared/text.hpp"

namespace gasgrain::cfd {

namespace {

constexpr double nowhere = std::numeric_limits<double>::max();
constexpr const char* names[] = {"velocity x",
                                 "velocity y",
                                 "velocity z",
                                 "pressure",
                                 "void fraction of the grains",
                                 "drag coefficient of the grains"};
constexpr int first_of_grains = 4;

// A value by field and cell; `code` orders them: the field's number first.
struct Suspect {
  int field = 0;
  Index3 cell{};  // global indices
  double value = 0.0;
};

// Fields by the numbers of `names`.
std::vector<const Field*> fields_of(GasSolver& solver) {
  const VectorField& u = solver.velocity();
  const GrainPhase& grains = solver.grains();
  return {
      &u[0], &u[1], &u[2], &solver.pressure(), &grains.void_fraction, &grains.momentum_exchange};
}

double code_of(const Decomposition& decomposition, int field, int i, int j, int k) {
  const Index3& lower = decomposition.block().lower;
  const Index3& cells = decomposition.grid().cells;
  const double cell =
      (i + lower[0]) + double(cells[0]) * ((j + lower[1]) + double(cells[1]) * (k + lower[2]));
  return field * double(cells[0]) * cells[1] * cells[2] + cell;
}

Suspect suspect_of(const Decomposition& decomposition, double code, double value) {
  const Index3& cells = decomposition.grid().cells;
  const auto all = static_cast<long long>(cells[0]) * cells[1] * cells[2];
  const auto number = static_cast<long long>(code);
  const long long cell = number % all;
  return {static_cast<int>(number / all),
          {static_cast<int>(cell % cells[0]), static_cast<int>(cell / cells[0] % cells[1]),
           static_cast<int>(cell / cells[0] / cells[1])},
          value};
}

// The value on the rank that found `code`, on all ranks.
double value_at(const Decomposition& decomposition, double code, double mine, double value) {
  const int rank = decomposition.rank();
  int owner = mine == code ? rank : decomposition.size();
  MPI_Allreduce(MPI_IN_PLACE, &owner, 1, MPI_INT, MPI_MIN, decomposition.communicator());
  MPI_Bcast(&value, 1, MPI_DOUBLE, owner, decomposition.communicator());
  return value;
}

// The first value that is not finite: lowest field, grains first, then lowest cell.
bool find_not_finite(Suspect& suspect, GasSolver& solver) {
  const Decomposition& decomposition = solver.decomposition();
  const std::vector<const Field*> fields = fields_of(solver);
  double first = nowhere, value = 0.0;
  for (int f : {4, 5, 0, 1, 2, 3}) {
    for_each_cell(decomposition.block().size, [&](int i, int j, int k) {
      if (first < nowhere || std::isfinite((*fields[f])(i, j, k))) return;
      first = code_of(decomposition, f, i, j, k);
      value = (*fields[f])(i, j, k);
    });
  }
  double lowest = first;
  MPI_Allreduce(MPI_IN_PLACE, &lowest, 1, MPI_DOUBLE, MPI_MIN, decomposition.communicator());
  if (lowest == nowhere) return false;
  suspect = suspect_of(decomposition, lowest, value_at(decomposition, lowest, first, value));
  return true;
}

Suspect find_largest_velocity(const GasSolver& solver) {
  const Decomposition& decomposition = solver.decomposition();
  double largest = -1.0, code = nowhere;
  for (int d = 0; d < 3; ++d) {
    for_each_cell(decomposition.block().size, [&](int i, int j, int k) {
      const double u = std::abs(solver.velocity()[d](i, j, k));
      if (u <= largest) return;
      largest = u;
      code = code_of(decomposition, d, i, j, k);
    });
  }
  const double mine = largest;
  largest = max_over_ranks(decomposition, largest);
  double lowest = mine == largest ? code : nowhere;
  MPI_Allreduce(MPI_IN_PLACE, &lowest, 1, MPI_DOUBLE, MPI_MIN, decomposition.communicator());
  return suspect_of(decomposition, lowest, largest);
}

std::string place(const Decomposition& decomposition, const Suspect& suspect) {
  const Grid& grid = decomposition.grid();
  const Index3& c = suspect.cell;
  const Vec3 x = grid.lower + Vec3(c[0] + 0.5, c[1] + 0.5, c[2] + 0.5).cwiseProduct(grid.spacing());
  return text("%s = %.4g in cell (%d, %d, %d) at (%.5g, %.5g, %.5g) m", names[suspect.field],
              suspect.value, c[0], c[1], c[2], x[0], x[1], x[2]);
}

// Name of the side or patch of the inlet that the cell may lie at, or "".
std::string inlet_at(const GasSolver& solver, const Index3& cell) {
  const Index3& cells = solver.decomposition().grid().cells;
  for (const SidePart& part : solver.side_parts()) {
    const int d = part.direction;
    if (part.stated.type != BoundaryType::inlet) continue;
    if (cell[d] != (part.side == 0 ? 0 : cells[d] - 1)) continue;
    return part.name.empty() ? names_of_sides[d][part.side] : "patch " + part.name;
  }
  return "";
}

std::string likely_cause(const GasSolver& solver, const Suspect& suspect, const StepReport& last,
                         double last_dt) {
  const Numerics& numerics = solver.gas_case().numerics;
  if (suspect.field >= first_of_grains) {
    return "the grains: look for grains without size, far outside or on top of each other";
  }
  if (std::isfinite(suspect.value) && last_dt > 0.0 &&
      last.courant_number <= numerics.courant_number) {
    return text(
        "the tolerance of the pressure or its iterations, the velocities are sound: "
        "numerics.pressure_tolerance is %.2g, numerics.pressure_iterations %d",
        numerics.pressure_tolerance, numerics.pressure_iterations);
  }
  if (const std::string side = inlet_at(solver, suspect.cell); !side.empty()) {
    return "the inlet of " + side +
           ": compare its velocity with the cells and with the gas the bodies leave it";
  }
  if (last_dt == 0.0) {
    return "the start: compare initial.velocity and the inlets with the cells and the end time";
  }
  return text(
      "the time step: the last one, %.4g s, ended with a Courant number of %.3g (limit %.3g) and "
      "%.4g m/s; take a smaller run.step or numerics.courant_number",
      last_dt, last.courant_number, numerics.courant_number, last.largest_speed);
}

}  // namespace

std::string describe_failure(GasSolver& solver, const StepReport& last, double last_dt) {
  Suspect suspect;
  const bool not_finite = find_not_finite(suspect, solver);
  if (!not_finite) suspect = find_largest_velocity(solver);
  return std::string(not_finite ? "first value that is not finite: " : "largest velocity: ") +
         place(solver.decomposition(), suspect) +
         "\n  likely cause: " + likely_cause(solver, suspect, last, last_dt);
}

}  // namespace gasgrain::cfd
