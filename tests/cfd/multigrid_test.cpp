// The multigrid-preconditioned solver against the operator it inverts, on the kind of coefficients
// a dense bed with tubes gives: contrast of a thousand between bed and freeboard, closed faces.
#include <gtest/gtest.h>

#include <cmath>

#include "cfd/halo_exchange.hpp"
#include "cfd/pressure_solver.hpp"

namespace gasgrain::cfd {
namespace {

// A repeatable number in [0, 1) for a global cell.
double noise(long n) {
  unsigned long x = static_cast<unsigned long>(n) * 0x9E3779B97F4A7C15UL + 0x7F4A7C15UL;
  x ^= x >> 31;
  x *= 0xBF58476D1CE4E5B9UL;
  x ^= x >> 29;
  return static_cast<double>(x >> 11) / 9007199254740992.0;
}

struct Scene {
  Decomposition blocks;
  PressureSystem system;
  Field exact;
};

enum class Ends { outlet, sealed };

// Coefficient of a cell: bed below 60 % of the height, freeboard above, two closed tubes.
double cell_coefficient(const Grid& grid, const Index3& cell) {
  const double z = (cell[2] + 0.5) / grid.cells[2];
  const double x = (cell[0] + 0.5) / grid.cells[0];
  for (const double centre : {0.3, 0.7}) {
    if (std::hypot((x - centre) * 0.05, (z - 0.25) * 0.2) < 0.005) return 0.0;
  }
  const long number = cell[0] + 1000L * cell[1] + 1000000L * cell[2];
  return z < 0.6 ? 1e-3 * (0.5 + noise(number)) : 1.0;
}

Scene make_scene(const Index3& cells, Ends ends) {
  Grid grid;
  grid.upper = Vec3(0.05, 0.01, 0.2);
  grid.cells = cells;
  Scene scene{.blocks = Decomposition(MPI_COMM_WORLD, grid, {false, false, false}),
              .system = {},
              .exact = {}};
  const Block& block = scene.blocks.block();
  for (Field& t : scene.system.transmissibility) t = Field(block.size);
  scene.system.diagonal = Field(block.size);
  scene.system.right_hand_side = Field(block.size);
  scene.exact = Field(block.size);
  const Vec3 h = grid.spacing();
  double sum = 0;
  for (int k = 0; k <= block.size[2]; ++k)
    for (int j = 0; j <= block.size[1]; ++j)
      for (int i = 0; i <= block.size[0]; ++i) {
        const Index3 cell{block.lower[0] + i, block.lower[1] + j, block.lower[2] + k};
        const bool owned = i < block.size[0] && j < block.size[1] && k < block.size[2];
        for (int d = 0; d < 3; ++d) {
          Index3 below = cell;
          --below[d];
          bool inside = below[d] >= 0;
          for (int e = 0; e < 3; ++e) inside = inside && cell[e] < grid.cells[e];
          if (!inside) continue;
          const double a = cell_coefficient(grid, cell);
          const double b = cell_coefficient(grid, below);
          const double mean = a > 0 && b > 0 ? 0.5 * (a + b) : 0.0;
          scene.system.transmissibility[d](i, j, k) = mean * h.prod() / (h[d] * h[d]);
        }
        if (!owned) continue;
        if (ends == Ends::outlet && cell[2] == grid.cells[2] - 1) {
          scene.system.diagonal(i, j, k) = 2 * h.prod() / (h[2] * h[2]);
        }
        const double c = cell_coefficient(grid, cell);
        const Vec3 x((cell[0] + 0.5) * h[0], (cell[1] + 0.5) * h[1], (cell[2] + 0.5) * h[2]);
        scene.exact(i, j, k) = c > 0 ? std::cos(130 * x[0]) * std::cos(20 * x[2]) +
                                           0.3 * noise(cell[0] + 77L * cell[2])
                                     : 0.0;
        sum += c > 0 ? 1 : 0;
      }
  // Right-hand side of the exact solution, hence compatible when the box is sealed.
  fill_ghosts(scene.blocks, scene.exact);
  for (int k = 0; k < block.size[2]; ++k)
    for (int j = 0; j < block.size[1]; ++j)
      for (int i = 0; i < block.size[0]; ++i) {
        const auto n = scene.exact.index(i, j, k);
        double value = scene.system.diagonal[n] * scene.exact[n];
        for (int d = 0; d < 3; ++d) {
          const auto s = scene.exact.stride(d);
          const Field& t = scene.system.transmissibility[d];
          value += t[n] * (scene.exact[n] - scene.exact[n - s]) +
                   t[n + s] * (scene.exact[n] - scene.exact[n + s]);
        }
        scene.system.right_hand_side[n] = value;
      }
  return scene;
}

// Largest deviation from the exact solution in open cells, up to a constant.
double deviation(const Scene& scene, const Field& pressure) {
  const Index3& size = scene.blocks.block().size;
  double shift = 0;
  double count = 0;
  double largest = 0;
  for (int pass = 0; pass < 2; ++pass) {
    for (int k = 0; k < size[2]; ++k)
      for (int j = 0; j < size[1]; ++j)
        for (int i = 0; i < size[0]; ++i) {
          if (scene.exact(i, j, k) == 0.0) continue;
          const double difference = pressure(i, j, k) - scene.exact(i, j, k);
          if (pass == 0) {
            shift += difference;
            count += 1;
          } else {
            largest = std::max(largest, std::abs(difference - shift));
          }
        }
    if (pass == 0) {
      shift = sum_over_ranks(scene.blocks, shift) / sum_over_ranks(scene.blocks, count);
    }
  }
  return max_over_ranks(scene.blocks, largest);
}

class MultigridOnShapes : public testing::TestWithParam<std::tuple<Index3, Ends>> {};

TEST_P(MultigridOnShapes, recovers_the_exact_solution_in_few_iterations) {
  const auto& [cells, ends] = GetParam();
  const Scene scene = make_scene(cells, ends);
  auto solver = make_pressure_solver(scene.blocks, PressureMethod::multigrid);
  Field pressure(scene.blocks.block().size);
  const PressureReport report = solver->solve(scene.system, 1e-11, 100, pressure);
  EXPECT_LE(report.residual, 1e-11);
  EXPECT_LE(report.iterations, 40);
  EXPECT_LT(deviation(scene, pressure), 1e-6);
  const PressureReport again = solver->solve(scene.system, 1e-10, 100, pressure);
  EXPECT_EQ(again.iterations, 0) << "a warm start from the solution has nothing to do";
}

INSTANTIATE_TEST_SUITE_P(BedsWithTubes, MultigridOnShapes,
                         testing::Combine(testing::Values(Index3{40, 8, 160}, Index3{37, 9, 61},
                                                          Index3{40, 1, 160}),
                                          testing::Values(Ends::outlet, Ends::sealed)));

}  // namespace
}  // namespace gasgrain::cfd
