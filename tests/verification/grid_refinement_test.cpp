// Convergence with the cells at a fixed width of the kernel.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

#include "tests/verification/gas_column.hpp"
#include "tests/verification/report.hpp"

namespace gasgrain::coupling {
namespace {

using verification::Report;

// What the scheme converges to in one dimension: the bed of height `height` from the floor, spread
// by the Gaussian kernel K that the floor reflects; drag with kernel means of eps and u, spread by
// K. Pa.
double pressure_drop_of_kernel(double height, double sigma, double length, double diameter,
                               double solid_fraction, double velocity,
                               const cfd::GasProperties& gas) {
  constexpr int n = 600;
  const double h = length / n;
  const auto at = [&](int i) { return (i + 0.5) * h; };
  const auto spread = [&](const std::vector<double>& f) {
    std::vector<double> result(n);
    for (int i = 0; i < n; ++i) {
      double sum = 0, weight = 0;
      for (int j = 0; j < n; ++j) {
        // images in the floor and in the upper end
        for (const double image : {at(j), -at(j), 2 * length - at(j)}) {
          const double w = std::exp(-0.5 * std::pow((at(i) - image) / sigma, 2));
          sum += w * f[j];
          weight += w;
        }
      }
      result[i] = sum / weight;
    }
    return result;
  };
  std::vector<double> solid(n), eps(n), u(n), drag(n);
  for (int i = 0; i < n; ++i)
    solid[i] = solid_fraction * std::clamp((height - i * h) / h, 0.0, 1.0);
  const std::vector<double> spread_solid = spread(solid);
  for (int i = 0; i < n; ++i) {
    eps[i] = 1 - spread_solid[i];
    u[i] = velocity / eps[i];
  }
  const std::vector<double> eps_felt = spread(eps), u_felt = spread(u);
  for (int i = 0; i < n; ++i) {
    const DragInput input{.void_fraction = eps_felt[i],
                          .diameter = diameter,
                          .slip = u_felt[i],
                          .density = gas.density,
                          .viscosity = gas.viscosity};
    drag[i] = solid[i] * drag_gidaspow(input);
  }
  const std::vector<double> spread_drag = spread(drag);
  double drop = 0;
  for (int i = 0; i < n; ++i) drop += h * spread_drag[i] * u[i] / eps[i];
  return drop;
}

constexpr double refined_diameter = 1e-3;         // of the grain, l = 10
const std::array<int, 3> refined_cells{1, 2, 4};  // in 5 d

std::string cell_label(int per_five) {
  std::ostringstream text;
  text << "cell/d " << 5.0 / per_five;
  return text.str();
}

double refined_pressure_drop(int per_five) {
  constexpr double d = refined_diameter, superficial = 0.01;
  const GasColumn column{.gas = {.upper = Vec3(0.01, 0.01, 0.06),
                                 .cells = {2 * per_five, 2 * per_five, 12 * per_five},
                                 .x = {"periodic", "periodic"},
                                 .z = {inlet(superficial), "outlet"}},
                         .velocity = Vec3(0, 0, superficial),
                         .coupling = "kernel_width = 0.004\n"};
  const CoupledCase given = column.read();
  GasCoupling coupling(given.gas, given.options, MPI_COMM_SELF);
  const std::vector<GrainRecord> grains =
      cubic({.original_diameter = 1e-4, .ratio = 10}, Vec3::Zero(), {10, 10, 30}, d);
  std::vector<Vec3> forces(grains.size());
  coupling.begin(forces, grains);
  for (int step = 0; step < 12; ++step) coupling.exchange(forces, grains, 1e-4);
  return coupling.gas().side_pressure(2, 0) - coupling.gas().side_pressure(2, 1);
}

TEST(GridRefinement, bed_pressure_drop_converges_at_fixed_kernel_width) {
  Report report("refined_bed", "bed of 30 d, kernel of 4 d: pressure drop against the cell size");
  const double exact =
      pressure_drop_of_kernel(0.03, 0.004, 0.06, 1e-4, M_PI / 6, 0.01, cfd::GasProperties{});
  std::vector<double> errors;
  for (const int per_five : refined_cells) {
    const double ratio = refined_pressure_drop(per_five) / exact;
    errors.push_back(std::abs(ratio - 1));
    report.check("pressure drop over that of the kernel; " + cell_label(per_five),
                 std::to_string(12 * per_five), ratio);
  }
  report.check("order of the error", "12/24/48", std::log(errors[0] / errors[2]) / std::log(4.0));
}

// A light grain hovers in the middle of a column of 20 d; its gas force disturbs the gas over the
// width of the kernel, whatever the cells.
double refined_terminal_velocity(int per_five) {
  constexpr double d = 1e-4, rising = 0.15;
  const GasColumn column{.gas = {.upper = Vec3::Constant(20 * d),
                                 .cells = {4 * per_five, 4 * per_five, 4 * per_five},
                                 .x = {"periodic", "periodic"},
                                 .z = {inlet(rising), "outlet"}},
                         .velocity = Vec3(0, 0, rising),
                         .coupling = "kernel_width = 0.0004\n"};
  const CoupledCase given = column.read();
  GasCoupling coupling(given.gas, given.options, MPI_COMM_SELF);
  const GrainKind kind{.original_diameter = d, .ratio = 1, .density = 500};
  std::vector<GrainRecord> grain{kind.record(Vec3(0.53, 0.48, 0.51) * 20 * d, Vec3::Zero())};
  std::vector<Vec3> force(1, Vec3::Zero());
  coupling.begin(force, grain);
  const double dt = std::min(2e-4, coupling.gas().largest_stable_step());
  for (double time = 0; time < 0.06; time += dt) {
    grain[0].velocity[2] += dt * (force[0][2] / grain[0].mass - gravity);
    coupling.exchange(force, grain, dt);
  }
  return rising - grain[0].velocity[2];
}

TEST(GridRefinement, terminal_velocity_converges_at_fixed_kernel_width) {
  Report report("refined_terminal_velocity",
                "single grain, two-way, kernel of 4 d: settling velocity against the cell size");
  std::vector<double> velocities;
  for (const int per_five : refined_cells) {
    velocities.push_back(refined_terminal_velocity(per_five));
    report.note("velocity (m/s); " + cell_label(per_five), std::to_string(4 * per_five),
                velocities.back());
  }
  report.check("change from cell/d 5 to 2.5 over the velocity", "4/8",
               std::abs(velocities[1] / velocities[2] - velocities[0] / velocities[2]));
  report.check("change from cell/d 2.5 to 1.25 over the velocity", "8/16",
               std::abs(1 - velocities[1] / velocities[2]));
}

}  // namespace
}  // namespace gasgrain::coupling
