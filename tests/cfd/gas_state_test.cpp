// What a solver saves is all that enters its next steps: restored into a new one, it goes on with
// the same bits.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>

#include "cfd/state_file.hpp"
#include "coupling/shared/error.hpp"
#include "tests/cfd/gas_scenes.hpp"
#include "tests/shared/error_checks.hpp"

namespace gasgrain::cfd {
namespace {

using testing::bodies;
using testing::set_moving_heap;
using testing::set_sides;
using testing::side;

// An open vessel, periodic in y, with a body, a moving wall and an inlet.
GasCase open_vessel() {
  GasCase c = testing::draught(Vec3(1.0, 0.6, 1.2), {9, 6, 12});
  c.boundaries[0][0].wall_velocity = Vec3(0, 0.2, 0.1);
  set_sides(c, 1, BoundaryType::periodic);
  c.bodies = bodies("[[body]]\nname='ball'\nsphere={center=[0.6,0.3,0.6],radius=0.2}\n");
  return c;
}

GasCase sealed_vessel() {
  GasCase c = open_vessel();
  c.boundaries[2][0] = c.boundaries[2][1] = side(BoundaryType::no_slip);
  return c;
}

GasCase stirred_vessel() {
  GasCase c = open_vessel();
  c.bodies = bodies(
      "[[body]]\nname='ball'\nsphere={center=[0.6,0.3,0.6],radius=0.2}\n"
      "motion={oscillate={amplitude=[0.1,0.05,0.02],period=0.05}}\n");
  return c;
}

GasCase two_stage_vessel() {
  GasCase c = open_vessel();
  c.numerics.time_scheme = TimeScheme::rk2;
  return c;
}

GasCase viscous_vessel() {
  GasCase c = open_vessel();
  c.numerics.viscosity = Viscosity::implicit_step;
  return c;
}

struct Scene {
  const char* name;
  GasCase gas_case;
  bool grains;
};

std::vector<Scene> scenes() {
  return {{"open_with_grains", open_vessel(), true},
          {"open", open_vessel(), false},
          {"sealed_with_grains", sealed_vessel(), true},
          {"moving_body", stirred_vessel(), false},
          {"two_stages", two_stage_vessel(), true},
          {"implicit_viscosity", viscous_vessel(), true}};
}

// Steps of different length, so that the weights of the old slope matter.
void advance(GasSolver& solver, int from, int to, bool grains) {
  for (int step = from; step < to; ++step) {
    if (grains) set_moving_heap(solver, 0.05 * step, 0.3, 40.0);
    if (grains && step == 0) solver.accept_void_fraction_as_old();
    solver.advance(1e-3 * (1.0 + 0.3 * (step % 3)));
  }
}

// Largest difference of velocities and pressure over all ranks, and of time and previous momentum.
double difference(const GasSolver& a, const GasSolver& b) {
  double largest = std::abs(a.time() - b.time());
  const auto compare = [&](const Field& x, const Field& y) {
    for_each_cell(x.size(), [&](int i, int j, int k) {
      largest = std::max(largest, std::abs(x(i, j, k) - y(i, j, k)));
    });
  };
  for (int d = 0; d < 3; ++d) compare(a.velocity()[d], b.velocity()[d]);
  compare(a.pressure(), b.pressure());
  return max_over_ranks(a.decomposition(), largest);
}

// A file that all ranks share, in the working directory, and that goes with the test.
class SharedFile {
 public:
  explicit SharedFile(const std::string& name) {
    int ranks = 1;
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    path_ = "gas_state_" + name + "_" + std::to_string(ranks) + ".h5";
  }
  ~SharedFile() {
    int rank = 0;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    std::error_code ignored;
    if (rank == 0) std::filesystem::remove(path_, ignored);
    MPI_Barrier(MPI_COMM_WORLD);
  }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

void save(GasSolver& solver, const std::string& path) {
  Hdf5File file = Hdf5File::create(path, MPI_COMM_WORLD);
  StateFile archive(file, "gas", solver.decomposition(), StateDirection::save);
  solver.visit_state(archive);
  file.close();
}

void restore(GasSolver& solver, const std::string& path) {
  Hdf5File file = Hdf5File::open(path, MPI_COMM_WORLD);
  StateFile archive(file, "gas", solver.decomposition(), StateDirection::restore);
  solver.visit_state(archive);
}

TEST(GasState, a_restored_solver_continues_with_the_same_bits) {
  for (const Scene& scene : scenes()) {
    SCOPED_TRACE(scene.name);
    const SharedFile file("bits");
    GasSolver first(scene.gas_case, MPI_COMM_WORLD);
    advance(first, 0, 4, scene.grains);
    save(first, file.path());
    GasSolver second(scene.gas_case, MPI_COMM_WORLD);
    restore(second, file.path());
    EXPECT_EQ(difference(first, second), 0.0);
    EXPECT_EQ(first.largest_stable_step(), second.largest_stable_step());
    advance(first, 4, 8, scene.grains);
    EXPECT_GT(difference(first, second), 1e-6);  // else the comparison would say nothing
    advance(second, 4, 8, scene.grains);
    EXPECT_EQ(difference(first, second), 0.0);
  }
}

TEST(GasState, the_momentum_budget_after_a_restart_is_that_of_the_uninterrupted_run) {
  const SharedFile file("budget");
  GasSolver first(open_vessel(), MPI_COMM_WORLD), second(open_vessel(), MPI_COMM_WORLD);
  advance(first, 0, 3, true);
  save(first, file.path());
  restore(second, file.path());
  for (GasSolver* solver : {&first, &second}) set_moving_heap(*solver, 0.2, 0.3, 40.0);
  const MomentumBudget a = first.advance(1e-3).momentum, b = second.advance(1e-3).momentum;
  EXPECT_EQ((a.convection - b.convection).norm(), 0.0);
  EXPECT_EQ((a.viscous - b.viscous).norm(), 0.0);
  EXPECT_LT(testing::imbalance(b).norm(), 1e-12 * testing::turnover(b));
}

TEST(GasState, a_copy_in_memory_turns_back_the_clock) {
  for (const Scene& scene : scenes()) {
    SCOPED_TRACE(scene.name);
    GasSolver solver(scene.gas_case, MPI_COMM_WORLD), twin(scene.gas_case, MPI_COMM_WORLD);
    StateCopy copy;
    const auto visit = [&](StateArchive& archive) { solver.visit_state(archive); };
    advance(solver, 0, 2, scene.grains);
    copy.save(visit);
    advance(solver, 2, 3, scene.grains);
    copy.save(visit);
    advance(solver, 3, 5, scene.grains);
    copy.restore(visit);
    advance(twin, 0, 3, scene.grains);
    EXPECT_EQ(difference(solver, twin), 0.0);
    advance(solver, 3, 5, scene.grains);
    advance(twin, 3, 5, scene.grains);
    EXPECT_EQ(difference(solver, twin), 0.0);
  }
}

// Each rank alone writes what the others then read together.
TEST(GasState, continues_on_another_number_of_ranks_to_the_accuracy_of_the_solver) {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  const SharedFile file("alone");
  GasCase gas_case = open_vessel();
  gas_case.numerics.pressure_tolerance = 1e-13;
  if (rank == 0) {
    GasSolver alone(gas_case, MPI_COMM_SELF);
    advance(alone, 0, 4, true);
    Hdf5File out = Hdf5File::create(file.path());
    StateFile archive(out, "gas", alone.decomposition(), StateDirection::save);
    alone.visit_state(archive);
    out.close();
  }
  MPI_Barrier(MPI_COMM_WORLD);
  GasSolver restored(gas_case, MPI_COMM_WORLD), whole(gas_case, MPI_COMM_WORLD);
  restore(restored, file.path());
  advance(restored, 4, 8, true);
  advance(whole, 0, 8, true);
  EXPECT_LT(difference(restored, whole), 1e-9);
}

TEST(GasState, of_another_grid_is_refused) {
  const SharedFile file("foreign");
  GasSolver solver(open_vessel(), MPI_COMM_WORLD);
  save(solver, file.path());
  GasCase other = open_vessel();
  other.grid.cells[2] += 1;
  GasSolver larger(other, MPI_COMM_WORLD);
  expect_contains(user_error([&] { restore(larger, file.path()); }), "its size differs");
}

}  // namespace
}  // namespace gasgrain::cfd
