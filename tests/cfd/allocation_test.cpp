// The step of the gas allocates nothing once its buffers have grown: counted are all calls of
// operator new and, on one rank, where MPI has nothing to do, also of malloc itself.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "tests/cfd/gas_fixture.hpp"

extern "C" void* __libc_malloc(std::size_t size);

namespace {

std::atomic<long> news{0}, mallocs{0};

}  // namespace

extern "C" void* malloc(std::size_t size) {
  ++mallocs;
  return __libc_malloc(size);
}

void* operator new(std::size_t size) {
  ++news;
  void* memory = std::malloc(size > 0 ? size : 1);
  if (!memory) throw std::bad_alloc();
  return memory;
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}

namespace gasgrain::cfd {
namespace {

GasCase vessel(bool sealed) {
  GasCase c = testing::box_case(Vec3(1, 0.6, 2), {12, 7, 24});
  c.gas = {.density = 1.2, .viscosity = 0.02, .gravity = Vec3(0, 0, -1)};
  if (!sealed) {
    c.boundaries[2][0] = testing::inlet(Vec3(0.1, 0, 0.5));
    c.boundaries[2][1] = testing::side(BoundaryType::outlet);
  }
  c.bodies = testing::bodies(
      "[[body]]\nname='tube'\ncylinder={point=[0.32,0,0.7],axis=[0,1,0],radius=0.17}\n");
  return c;
}

struct Counts {
  long news, mallocs;
};

// Allocations in the gas steps 3 ... 8 and in what an exchange with grains reads after them.
Counts allocations(const GasCase& gas_case) {
  GasSolver solver(gas_case, MPI_COMM_WORLD);
  testing::set_moving_heap(solver, 0.0, 0.2, 40.0);
  solver.accept_void_fraction_as_old();
  VectorField velocity_at_cells, gradient_at_cells;
  Counts sum{0, 0};
  for (int step = 1; step <= 8; ++step) {
    testing::set_moving_heap(solver, 0.02 * step, 0.2, 40.0);
    const Counts before{news, mallocs};
    solver.advance(1e-3);
    solver.sample_at_cells(velocity_at_cells, gradient_at_cells);
    if (step < 3) continue;
    sum.news += news - before.news;
    sum.mallocs += mallocs - before.mallocs;
  }
  return sum;
}

void expect_none(const GasCase& gas_case) {
  int ranks = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  const Counts counts = allocations(gas_case);
  EXPECT_EQ(counts.news, 0);
  if (ranks == 1) {
    EXPECT_EQ(counts.mallocs, 0);
  }
}

TEST(Allocation, the_count_notices_an_allocation) {
  const Counts before{news, mallocs};
  const std::vector<double> values(7);
  EXPECT_EQ(values.size(), 7U);
  EXPECT_EQ(news - before.news, 1);
  EXPECT_EQ(mallocs - before.mallocs, 1);
}

TEST(Allocation, no_step_after_the_second_allocates_in_an_open_vessel) {
  expect_none(vessel(false));
}

TEST(Allocation, no_step_after_the_second_allocates_in_a_sealed_vessel) {
  expect_none(vessel(true));
}

TEST(Allocation, no_step_after_the_second_allocates_without_grains_and_bodies) {
  GasCase c = vessel(false);
  c.bodies.clear();
  GasSolver solver(c, MPI_COMM_WORLD);
  for (int step = 0; step < 3; ++step) solver.advance(1e-3);
  const long before = news;
  for (int step = 0; step < 5; ++step) solver.advance(1e-3);
  EXPECT_EQ(news - before, 0);
}

}  // namespace
}  // namespace gasgrain::cfd
