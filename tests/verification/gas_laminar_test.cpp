// Laminar flows with known solutions: observed order over three grids and errors against bounds.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/cfd/gas_fixture.hpp"
#include "tests/verification/report.hpp"

namespace gasgrain::cfd {
namespace {

using testing::bodies;
using testing::box_case;
using testing::set_sides;
using verification::observed_order;
using verification::Report;

// Advances at the largest stable step times `factor` until `time`.
void run_until(GasSolver& solver, double time, double factor = 1.0) {
  while (solver.time() < time * (1.0 - 1e-12)) {
    solver.advance(std::min(factor * solver.largest_stable_step(), time - solver.time()));
  }
}

// Channel of height 1 between z_lower and z_upper, driven by gravity along x; flow rate over the
// exact 1/12 g H^3/nu, minus one.
double grid_wall_error(int cells) {
  GasCase c = box_case(Vec3(1, 1, 1), {1, 1, cells});
  c.gas.gravity = Vec3(1, 0, 0);
  set_sides(c, 0, BoundaryType::periodic);
  set_sides(c, 1, BoundaryType::slip);
  GasSolver solver(c, MPI_COMM_WORLD);
  run_until(solver, 1.0);  // exp(-pi^2) = 5e-5 from the steady state
  return 12.0 * solver.side_flux(0, 0) - 1.0;
}

TEST(Poiseuille, flow_rate_between_grid_walls_is_second_order) {
  Report report("poiseuille", "channel between walls on grid lines, driven by a body force");
  const double e8 = grid_wall_error(8), e16 = grid_wall_error(16), e32 = grid_wall_error(32);
  report.check("order of the flow rate", "8; 16", observed_order(e8, e16));
  report.check("order of the flow rate", "16; 32", observed_order(e16, e32));
  report.check("flow rate over exact", "32", 1.0 + e32);
}

// Positions of the two walls within their cells, in [0, 1).
struct Offsets {
  double lower, upper;
};

// Evenly scattered pairs (the additive sequence of the plastic number).
Offsets scattered(int n) {
  return {std::fmod(0.5 + 0.7548776662466927 * n, 1.0),
          std::fmod(0.5 + 0.5698402909980532 * n, 1.0)};
}

// The channel between two plane bodies about `cells` cells apart, both off the grid lines. Starts
// from the exact profile and runs until 99 % of its change to the discrete one is done. `factor`:
// of the largest stable step.
double body_wall_error(int cells, const Offsets& offsets,
                       BodyMethod method = BodyMethod::interpolation, double factor = 1.0) {
  const double h = 1.0 / cells, lower = (2.0 + offsets.lower) * h;
  const double height = 1.0 + (offsets.upper - offsets.lower) * h;
  GasCase c = box_case(Vec3(h, h, 1.0 + 5.0 * h), {1, 1, cells + 5});
  c.gas.gravity = Vec3(1, 0, 0);
  c.numerics.immersed_boundary = method;
  set_sides(c, 0, BoundaryType::periodic);
  set_sides(c, 1, BoundaryType::slip);
  c.bodies = bodies("[[body]]\nname='lower'\nplane={point=[0,0," + std::to_string(lower) +
                    "],normal=[0,0,1]}\n[[body]]\nname='upper'\nplane={point=[0,0," +
                    std::to_string(lower + height) + "],normal=[0,0,-1]}\n");
  GasSolver solver(c, MPI_COMM_WORLD);
  solver.set_velocity([&](const Vec3& x) {
    const double z = x[2] - lower;
    return Vec3(std::max(0.5 * z * (height - z), 0.0), 0, 0);
  });
  run_until(solver, 0.5, factor);
  double flow = 0.0;  // integral of the velocity over the faces
  for_each_cell(solver.pressure().size(),
                [&](int i, int j, int k) { flow += h * solver.velocity()[0](i, j, k); });
  flow = sum_over_ranks(solver.decomposition(), flow);
  return 12.0 * flow / (height * height * height) - 1.0;
}

struct ErrorOverOffsets {
  double mean = 0.0, worst = 0.0;
};

ErrorOverOffsets body_wall_errors(int cells, int offsets,
                                  BodyMethod method = BodyMethod::interpolation) {
  ErrorOverOffsets result;
  for (int n = 0; n < offsets; ++n) {
    const double error = std::abs(body_wall_error(cells, scattered(n), method));
    result.mean += error / offsets;
    result.worst = std::max(result.worst, error);
  }
  return result;
}

TEST(Poiseuille, body_walls_off_the_grid_lines_keep_the_flow_rate) {
  Report report("off_grid_channel", "channel between bodies off the grid lines, 40 offsets");
  const ErrorOverOffsets e = body_wall_errors(16, 40);
  report.check("mean error of the flow rate", "16", e.mean);
  report.check("worst error of the flow rate", "16", e.worst);
}

TEST(Poiseuille, body_walls_off_the_grid_lines_are_second_order) {
  Report report("off_grid_channel_order", "channel between bodies off the grid lines, 8 offsets");
  const double e8 = body_wall_errors(8, 8).mean, e16 = body_wall_errors(16, 8).mean,
               e32 = body_wall_errors(32, 8).mean;
  report.check("order of the mean error", "8; 16", observed_order(e8, e16));
  report.check("order of the mean error", "16; 32", observed_order(e16, e32));
}

// Largest change of the flow rate among four offsets when the step is a quarter of the stable one.
double effect_of_the_step(BodyMethod method) {
  double largest = 0.0;
  for (int n = 0; n < 4; ++n) {
    const double change = body_wall_error(16, scattered(n), method, 0.25) -
                          body_wall_error(16, scattered(n), method, 1.0);
    largest = std::max(largest, std::abs(change));
  }
  return largest;
}

TEST(Poiseuille, volume_forcing_is_of_first_order_and_depends_on_the_step) {
  Report report("volume_forcing_channel",
                "channel between bodies off the grid lines, volume forcing for comparison");
  const auto error = [](int cells) {
    return body_wall_errors(cells, 8, BodyMethod::volume_forcing);
  };
  const ErrorOverOffsets e8 = error(8), e16 = error(16), e32 = error(32);
  report.check("worst error of the flow rate", "16", e16.worst);
  report.check("order of the mean error", "8; 32", observed_order(e8.mean, e32.mean, 4.0));
  report.check("change of the flow rate by a quarter of the step", "16",
               effect_of_the_step(BodyMethod::volume_forcing));
  report.check("the same with interpolation", "16", effect_of_the_step(BodyMethod::interpolation));
}

struct Vortices {
  double energy_error;    // kinetic energy over the exact one, minus one
  double velocity_error;  // root mean square of u_x, m/s
};

// Taylor-Green vortices of unit wavenumber; energy decays as exp(-4 nu t).
Vortices taylor_green(int cells, Convection convection) {
  const double length = 2.0 * std::numbers::pi, nu = 0.05, time = 1.0;
  GasCase c = box_case(Vec3(length, length / cells, length), {cells, 1, cells});
  c.gas.viscosity = nu;
  c.numerics.convection = convection;
  c.numerics.pressure_tolerance = 1e-8;
  set_sides(c, 0, BoundaryType::periodic);
  set_sides(c, 1, BoundaryType::slip);
  set_sides(c, 2, BoundaryType::periodic);
  const auto exact = [&](const Vec3& x, double t) {
    const double f = std::exp(-2.0 * nu * t);
    return Vec3(f * std::sin(x[0]) * std::cos(x[2]), 0.0, -f * std::cos(x[0]) * std::sin(x[2]));
  };
  GasSolver solver(c, MPI_COMM_WORLD);
  solver.set_velocity([&](const Vec3& x) { return exact(x, 0.0); });
  const int steps = 3 * cells / 2;
  for (int n = 0; n < steps; ++n) solver.advance(time / steps);
  const double h = length / cells;
  std::vector<double> sums(3, 0.0);  // energy, exact energy, squared error
  for_each_cell(solver.pressure().size(), [&](int i, int j, int k) {
    const Vec3 x = testing::cell_centre(solver.decomposition(), i, j, k);
    const Vec3 u = exact(x - 0.5 * h * Vec3::UnitX(), time),
               w = exact(x - 0.5 * h * Vec3::UnitZ(), time);
    const double a = solver.velocity()[0](i, j, k), b = solver.velocity()[2](i, j, k);
    sums[0] += a * a + b * b;
    sums[1] += u[0] * u[0] + w[2] * w[2];
    sums[2] += (a - u[0]) * (a - u[0]) / (cells * cells);
  });
  sum_over_ranks(solver.decomposition(), sums);
  return {sums[0] / sums[1] - 1.0, std::sqrt(sums[2])};
}

void report_taylor_green(Report& report, Convection convection) {
  std::vector<Vortices> errors;
  for (const int cells : {16, 32, 64}) {
    const std::string n = std::to_string(cells), grid = n + " x " + n;
    errors.push_back(taylor_green(cells, convection));
    report.note("energy over exact", grid, 1.0 + errors.back().energy_error);
  }
  report.check("energy over exact at 64 x 64", "64 x 64", 1.0 + errors[2].energy_error);
  report.check("order of the velocity", "16; 32",
               observed_order(errors[0].velocity_error, errors[1].velocity_error));
  report.check("order of the velocity", "32; 64",
               observed_order(errors[1].velocity_error, errors[2].velocity_error));
  report.check(
      "order of the energy", "16; 64",
      observed_order(std::abs(errors[0].energy_error), std::abs(errors[2].energy_error), 4.0));
}

TEST(TaylorGreen, central_convection_is_second_order) {
  Report report("taylor_green", "Taylor-Green vortices, central convection");
  report_taylor_green(report, Convection::central);
}

TEST(TaylorGreen, van_leer_convection_converges) {
  Report report("taylor_green_van_leer", "Taylor-Green vortices, van Leer convection");
  report_taylor_green(report, Convection::van_leer);
}

}  // namespace
}  // namespace gasgrain::cfd
