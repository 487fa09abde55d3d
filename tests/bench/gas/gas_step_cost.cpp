// Cost of a gas step by pass, for one case and one pressure method: one line of JSON. compare.py
// runs it for the whole table.
//
// Grains are a smooth heap that wanders through the vessel with the speed of a bubbling bed, so
// that coefficients and right-hand side change in every step and the last pressure is only a first
// guess. Every time is the median over the steps of the largest of all ranks.
#include <mpi.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "coupling/shared/error.hpp"
#include "tests/cfd/gas_fixture.hpp"

namespace {

using namespace gasgrain::cfd;
using gasgrain::Vec3;

struct Options {
  std::vector<int> cells{40, 8, 160};
  std::string geometry = "tubes";  // box, tubes, die
  std::string method = "multigrid";
  bool sealed = false, grains = true, drag = true, viscosity = true;
  int steps = 20;
};

constexpr int warm_up_steps = 3;
constexpr double step_per_spacing = 0.04;  // s/m
constexpr double heap_speed = 30.0;        // phase per s: moves the heap at about 0.3 m/s
constexpr double mean_solid = 0.2;         // of the vessel's volume
constexpr double drag_coefficient = 3e4;   // B over the solid fraction, kg m^-3 s^-1

PressureMethod method_of(const std::string& name) {
  if (name == "hypre-pfmg") return PressureMethod::hypre_pfmg;
  if (name == "hypre-pfmg-rap") return PressureMethod::hypre_pfmg_rap;
  if (name == "hypre-smg") return PressureMethod::hypre_smg;
  if (name == "hypre-boomeramg") return PressureMethod::hypre_boomeramg;
  return PressureMethod::multigrid;
}

std::string bodies_of(const std::string& geometry) {
  if (geometry == "die") {
    return "[[body]]\nname='die'\ncomplement={cylinder={start=[0.025,0.025,0.001],"
           "end=[0.025,0.025,0.1],radius=0.0235}}\n";
  }
  std::string text;
  for (const char* point :
       {"[0.015,0,0.02]", "[0.035,0,0.02]", "[0.015,0,0.04]", "[0.035,0,0.04]"}) {
    text += "[[body]]\nname='tube" + std::to_string(text.size()) + "'\ncylinder={point=" + point +
            ",axis=[0,1,0],radius=0.0025}\n";
  }
  return text;
}

GasCase make_case(const Options& options) {
  const bool die = options.geometry == "die";
  GasCase c = testing::box_case(die ? Vec3(0.05, 0.05, 0.05) : Vec3(0.05, 0.01, 0.2),
                                {options.cells[0], options.cells[1], options.cells[2]});
  c.gas = {
      .density = 1.2, .viscosity = options.viscosity ? 1.8e-5 : 0.0, .gravity = Vec3(0, 0, -9.81)};
  c.numerics.pressure_tolerance = 1e-6;
  c.numerics.pressure_solver = method_of(options.method);
  if (!options.sealed) {
    if (!die) c.boundaries[2][0] = testing::inlet(Vec3(0, 0, 0.3));
    c.boundaries[2][1] = testing::side(BoundaryType::outlet);
  }
  if (options.cells[1] == 1) testing::set_sides(c, 1, BoundaryType::slip);
  if (options.geometry != "box") c.bodies = testing::bodies(bodies_of(options.geometry));
  return c;
}

struct Sample {
  std::vector<double> wall, cpu;  // per pass, s
};

// Largest over the ranks, pass by pass.
Sample sample_of(const StepReport& report) {
  Sample sample;
  for (const PassTime& pass : report.times) {
    sample.wall.push_back(pass.wall);
    sample.cpu.push_back(pass.cpu);
  }
  for (std::vector<double>* times : {&sample.wall, &sample.cpu}) {
    times->push_back(0.0);  // the whole step
    for (std::size_t n = 0; n + 1 < times->size(); ++n) times->back() += (*times)[n];
    MPI_Allreduce(MPI_IN_PLACE, times->data(), static_cast<int>(times->size()), MPI_DOUBLE, MPI_MAX,
                  MPI_COMM_WORLD);
  }
  return sample;
}

double median(const std::vector<Sample>& samples, std::vector<double> Sample::*kind,
              std::size_t pass) {
  std::vector<double> values;
  for (const Sample& sample : samples) values.push_back((sample.*kind)[pass]);
  std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
  return values[values.size() / 2];
}

void print(const Options& options, const std::vector<Sample>& samples, double iterations,
           int fallbacks) {
  const auto& cells = options.cells;
  int ranks = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  std::printf("{\"cells\": %ld, \"ranks\": %d, \"geometry\": \"%s\", \"method\": \"%s\", ",
              long(cells[0]) * cells[1] * cells[2], ranks, options.geometry.c_str(),
              options.method.c_str());
  std::printf("\"sealed\": %d, \"grains\": %d, \"drag\": %d, \"viscosity\": %d, ", options.sealed,
              options.grains, options.drag, options.viscosity);
  std::printf("\"iterations\": %.2f, \"fallbacks\": %d", iterations, fallbacks);
  for (std::size_t pass = 0; pass <= pass_names.size(); ++pass) {
    const char* name = pass < pass_names.size() ? pass_names[pass] : "step";
    std::printf(", \"%s\": {\"wall\": %.6g, \"cpu\": %.6g}", name,
                median(samples, &Sample::wall, pass), median(samples, &Sample::cpu, pass));
  }
  std::printf("}\n");
}

void run(const Options& options) {
  GasSolver solver(make_case(options), MPI_COMM_WORLD);
  const Vec3 spacing = solver.decomposition().grid().spacing();
  const double smallest = std::min(spacing[0], spacing[2]);
  const double dt = step_per_spacing * smallest;
  const auto set_grains = [&](int step) {
    if (!options.grains) return;
    const double phase = heap_speed * step * dt;
    testing::set_moving_heap(solver, phase, mean_solid, options.drag ? drag_coefficient : 0.0);
  };
  set_grains(0);
  solver.accept_void_fraction_as_old();
  std::vector<Sample> samples;
  double iterations = 0.0;
  int fallbacks = 0;
  for (int step = 1; step <= warm_up_steps + options.steps; ++step) {
    set_grains(step);
    const StepReport report = solver.advance(dt);
    if (step <= warm_up_steps) continue;
    samples.push_back(sample_of(report));
    iterations += double(report.pressure.iterations) / options.steps;
    fallbacks += report.pressure.fallbacks;
  }
  if (solver.decomposition().rank() == 0) print(options, samples, iterations, fallbacks);
}

}  // namespace

int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  Options options;
  CLI::App app{"Cost of a gas step by pass"};
  app.add_option("--cells", options.cells)->expected(3);
  app.add_option("--geometry", options.geometry)->check(CLI::IsMember({"box", "tubes", "die"}));
  app.add_option("--method", options.method)
      ->check(CLI::IsMember(
          {"multigrid", "hypre-pfmg", "hypre-pfmg-rap", "hypre-smg", "hypre-boomeramg"}));
  app.add_option("--steps", options.steps)->check(CLI::Range(1, 100000));
  app.add_flag("--sealed", options.sealed);
  app.add_flag("!--no-grains", options.grains);
  app.add_flag("!--no-drag", options.drag);
  app.add_flag("!--no-viscosity", options.viscosity);
  int code = 0;
  try {
    app.parse(argc, argv);
    run(options);
  } catch (const CLI::ParseError& error) {
    code = app.exit(error);
  } catch (const gasgrain::UserError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    code = 1;
  }
  MPI_Finalize();
  return code;
}
