// Cost of spreading grains over cells and gathering back, per grain and coupling step on one core:
//
//   build/bin/mapping_cost [--grains 250000] [--mapping spline] [--repeats 15]
//
// The bed with tubes (docs/performance.md): 40 x 8 x 160 cells of 1.25 mm, grains of 0.5 mm to a
// solid fraction of 0.55 from the bottom up, in the order of cells as LIGGGHTS sorts them. A
// coupling step locates the grains, deposits volumes (1 value) and drag (4), and gathers void
// fraction with velocity (4) and velocity with pressure gradient (6); smoothing is part of all
// four. Medians of CPU time in ns per grain. Before each pass all arrays were touched by the pass
// before, as in a run.
#include <mpi.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <functional>
#include <random>
#include <vector>

#include "cfd/gas_case.hpp"
#include "cfd/side_conditions.hpp"
#include "coupling/void_fraction.hpp"

namespace {

using namespace gasgrain;
using namespace gasgrain::coupling;

constexpr double diameter = 5e-4;  // m
constexpr double solid_fraction = 0.55;

struct Scene {
  cfd::Grid grid{.lower = Vec3::Zero(), .upper = Vec3(0.05, 0.01, 0.2), .cells = {40, 8, 160}};
  cfd::Decomposition decomposition{MPI_COMM_SELF, grid, {false, false, false}};
  cfd::WallGeometry walls;
  std::vector<Vec3> positions;

  explicit Scene(int count) {
    cfd::Boundaries sides;
    for (auto& direction : sides) {
      for (auto& side : direction) side.type = cfd::BoundaryType::no_slip;
    }
    walls = cfd::make_wall_geometry(decomposition, cfd::SideConditions(grid, sides), {});
    const double volume = count * M_PI / 6 * std::pow(diameter, 3) / solid_fraction;
    const double height = std::min(volume / (0.05 * 0.01), grid.upper[2]);
    std::mt19937 random(1);
    std::uniform_real_distribution<double> share(0.0, 1.0);
    for (int n = 0; n < count; ++n) {
      const double x = share(random), y = share(random), z = share(random);
      positions.emplace_back(x * grid.upper[0], y * grid.upper[1], z * height);
    }
    const auto number = [&](const Vec3& x) {
      const cfd::Index3 cell = grid.cell_of(x);
      return cell[0] + grid.cells[0] * (cell[1] + grid.cells[1] * cell[2]);
    };
    std::stable_sort(positions.begin(), positions.end(),
                     [&](const Vec3& a, const Vec3& b) { return number(a) < number(b); });
  }
};

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
  return values[values.size() / 2];
}

// One line of the table: the passes of a coupling step in ns per grain, and their sum.
void measure(const Scene& scene, Mapping mapping, int repeats) {
  Deposition deposition(scene.decomposition, scene.walls, mapping);
  const bool smooths = mapping == Mapping::spline;
  deposition.set_width(smooths ? 0.8 * scene.grid.spacing()[0] : 0.0, diameter);
  const std::size_t count = scene.positions.size();
  const std::vector<double> diameters(count, diameter);
  std::vector<std::array<double, 1>> one(count, {1e-10});
  std::vector<std::array<double, 4>> four(count, {1e-10, 1e-10, 1e-10, 1e-10});
  std::vector<std::array<double, 6>> six(count);
  std::array<cfd::Field, 6> f;
  f.fill(cfd::Field(scene.decomposition.block().size, 0.5));
  const std::vector<std::function<void()>> passes{
      [&] { deposition.locate(scene.positions, diameters); },
      [&] { deposition.deposit<1>({&f[0]}, one); },
      [&] {
        deposition.gather<4>(four, {&f[0], &f[1], &f[2], &f[3]});
      },
      [&] {
        deposition.deposit<4>({&f[0], &f[1], &f[2], &f[3]}, four);
      },
      [&] {
        deposition.gather<6>(six, {&f[0], &f[1], &f[2], &f[3], &f[4], &f[5]});
      }};
  std::vector<std::vector<double>> samples(passes.size() + 1);
  for (int n = -1; n < repeats; ++n) {  // the first one warms up
    double sum = 0;
    for (std::size_t pass = 0; pass < passes.size(); ++pass) {
      const double start = cpu_seconds();
      passes[pass]();
      const double cost = (cpu_seconds() - start) * 1e9 / double(count);
      sum += cost;
      if (n >= 0) samples[pass].push_back(cost);
    }
    if (n >= 0) samples.back().push_back(sum);
  }
  std::printf("| %-9s |", mapping_name(mapping).c_str());
  for (const auto& values : samples) std::printf(" %8.1f |", median(values));
  std::printf("\n");
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  int grains = 250000, repeats = 15;
  CLI::App app{"Cost of deposition and gather per grain and coupling step"};
  app.add_option("--grains", grains)->check(CLI::Range(1000, 10000000));
  std::vector<std::string> mappings = mapping_names();
  app.add_option("--mapping", mappings)->check(CLI::IsMember(mapping_names()));
  app.add_option("--repeats", repeats)->check(CLI::Range(1, 1000));
  int code = 0;
  try {
    app.parse(argc, argv);
    const Scene scene(grains);
    std::printf("ns per grain, %d grains of 0.5 mm in cells of 1.25 mm\n", grains);
    std::printf(
        "| mapping   |   locate | deposit1 |  gather4 | deposit4 |  gather6 | together |\n");
    std::printf("|---|---|---|---|---|---|---|\n");
    for (const std::string& name : mappings) measure(scene, find_mapping(name), repeats);
  } catch (const CLI::ParseError& error) {
    code = app.exit(error);
  }
  MPI_Finalize();
  return code;
}
