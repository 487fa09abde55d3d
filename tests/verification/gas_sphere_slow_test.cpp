// Steady flow past a sphere at Re 100, a quarter of it behind two planes of symmetry.
#include <gtest/gtest.h>

#include <memory>
#include <sstream>

#include "tests/verification/flow_tools.hpp"
#include "tests/verification/report.hpp"

namespace gasgrain::verification {
namespace {

using cfd::GasSolver;

// Diameter, speed and density 1; 4 diameters before, 6 behind and 4 beside the sphere.
cfd::GasCase quarter_sphere(int cells_per_diameter) {
  const int n = cells_per_diameter;
  std::ostringstream toml;
  toml << "[grid]\nlower = [-4, 0, 0]\nupper = [6, 4, 4]\ncells = [" << 10 * n << ", " << 4 * n
       << ", " << 4 * n << "]\n"
       << R"([gas]
density = 1
viscosity = 0.01
[boundary]
x_lower = {type = "inlet", superficial_velocity = 1}
x_upper = {type = "outlet"}
y_lower = {type = "slip"}
y_upper = {type = "slip"}
z_lower = {type = "slip"}
z_upper = {type = "slip"}
[numerics]
convection = "central"
pressure_tolerance = 1e-3
[[body]]
name = "sphere"
sphere = {center = [0, 0, 0], radius = 0.5}
)";
  return cfd::read_gas_case(ConfigTable::parse(toml.str(), "sphere.toml"));
}

// F / (rho U^2/2 pi D^2/4) of the whole sphere.
double drag_coefficient(const GasSolver& solver) {
  const cfd::BodyLoad& load = solver.body_loads().front();
  return 4.0 * (load.pressure + load.friction)[0] / (0.5 * 0.25 * 3.14159265358979);
}

TEST(Sphere, drag_at_re_100) {
  Report report("sphere_re_100", "sphere, Re 100, grid 4 + 6 x 8 x 8 diameters");
  std::unique_ptr<GasSolver> solver;
  for (const int cells : {10, 20}) {
    auto finer = std::make_unique<GasSolver>(quarter_sphere(cells), MPI_COMM_WORLD);
    finer->set_velocity(solver ? sampled_velocity(*solver)
                               : [](const Vec3&) { return Vec3(1.0, 0, 0); });
    solver = std::move(finer);
    advance_by(*solver, cells == 10 ? 9.0 : 1.0);
    advance_until_steady(*solver, 0.5, 2e-3, 10, [&] { return drag_coefficient(*solver); });
    const std::string grid = "D/dx " + std::to_string(cells);
    if (cells == 20)
      report.check("drag coefficient", grid, drag_coefficient(*solver));
    else
      report.note("drag coefficient", grid, drag_coefficient(*solver));
  }
}

}  // namespace
}  // namespace gasgrain::verification
