// Gas and grains at given places and velocities, without a DEM code: what the mapping costs in
// noise, convergence with the grid, and the balance of weight and gas force.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "cfd/loops.hpp"
#include "coupling/shared/error.hpp"
#include "tests/coupling/coupling_scene.hpp"
#include "tests/coupling/random_packing.hpp"
#include "tests/verification/report.hpp"

namespace gasgrain::coupling {
namespace {

using verification::Report;

constexpr double gravity = 9.81;

struct Gas {
  double density = 1.0, viscosity = 1.8e-5;
};

struct Column {
  Vec3 upper;
  cfd::Index3 cells;
  Gas gas = {};
  std::string sides = "periodic";            // of x and y
  std::string below = "type = \"no-slip\"";  // the ends
  std::string above = "type = \"no-slip\"";
  Vec3 velocity = Vec3::Zero();  // initial
  std::string coupling = {};     // keys of that section

  CoupledCase read() const {
    std::string text = format("[grid]\nlower = [0, 0, 0]\nupper = [%.17g, %.17g, %.17g]\n",
                              upper[0], upper[1], upper[2]);
    text += format("cells = [%g, %g, %g]\n", double(cells[0]), double(cells[1]), double(cells[2]));
    text += format("[gas]\ndensity = %.17g\nviscosity = %.17g\n[boundary]\n", gas.density,
                   gas.viscosity, 0);
    for (const char* side : {"x_lower", "x_upper", "y_lower", "y_upper"})
      text += std::string(side) + " = {type = \"" + sides + "\"}\n";
    text += "z_lower = {" + below + "}\nz_upper = {" + above + "}\n";
    text += format("[initial]\nvelocity = [%.17g, %.17g, %.17g]\n", velocity[0], velocity[1],
                   velocity[2]);
    return CoupledCase(text + "[numerics]\npressure_tolerance = 1e-9\n[coupling]\n" + coupling);
  }

  static std::string format(const char* pattern, double a, double b, double c) {
    char text[200];
    std::snprintf(text, sizeof text, pattern, a, b, c);
    return text;
  }
};

std::string inlet(double superficial_velocity) {
  return Column::format("type = \"inlet\", superficial_velocity = %.17g", superficial_velocity, 0,
                        0);
}

// Grains on a cubic lattice of that spacing in a box of `count` places.
std::vector<GrainRecord> cubic(const GrainKind& kind, const Vec3& lower, const cfd::Index3& count,
                               double spacing) {
  std::vector<GrainRecord> grains;
  cfd::for_each_cell(count, [&](int i, int j, int k) {
    grains.push_back(kind.record(lower + spacing * Vec3(i + 0.5, j + 0.5, k + 0.5), Vec3::Zero()));
  });
  return grains;
}

// Spacing of a cubic lattice with that solid fraction.
double lattice_spacing(double diameter, double solid_fraction) {
  return diameter * std::cbrt(M_PI / 6 / solid_fraction);
}

// beta of Ergun's equation at a slip velocity, as eq 14.
double ergun(double eps, double diameter, const Gas& gas, double slip) {
  return 150 * (1 - eps) * (1 - eps) * gas.viscosity / (eps * diameter * diameter) +
         1.75 * (1 - eps) * gas.density * slip / diameter;
}

// A rigid random packing and the gas in it drift through the grid together: no slip, so the exact
// gradient of the pressure is zero. What is there instead comes from d(eps)/dt on the grid. Root
// mean square of |grad p| in the cells over the gradient that carries the bed.
double gradient_noise(double grain, const std::string& mapping) {
  constexpr double box = 0.01, interval = 1e-4;
  const Vec3 drift = 0.1 * Vec3(0.3, 0.2, 1.0).normalized();
  const Column column{.upper = Vec3::Constant(box),
                      .cells = {8, 8, 8},
                      .below = "type = \"periodic\"",
                      .above = "type = \"periodic\"",
                      .velocity = drift,
                      .coupling = "mapping = \"" + mapping + "\"\n"};
  const GrainKind kind{.original_diameter = 1e-4, .ratio = grain / 1e-4};
  std::vector<GrainRecord> grains;
  for (const Vec3& x : random_packing(10, 0.56, static_cast<int>(std::lround(1e-3 / grain))))
    grains.push_back(kind.record(grain * x, drift));
  const CoupledCase given = column.read();
  GasCoupling coupling(given.gas, given.options, MPI_COMM_SELF);
  std::vector<Vec3> forces(grains.size());
  coupling.begin(forces, grains);
  cfd::VectorField velocity, gradient;
  for (int d = 0; d < 3; ++d) velocity[d] = gradient[d] = cfd::Field({8, 8, 8});
  double sum = 0;
  int samples = 0;
  for (int step = 1; step <= 120; ++step) {
    for (GrainRecord& g : grains) g.position += interval * g.velocity;
    coupling.exchange(forces, grains, interval);
    if (step <= 20) continue;
    coupling.gas().sample_at_cells(velocity, gradient);
    cfd::for_each_cell({8, 8, 8}, [&](int i, int j, int k) {
      for (int d = 0; d < 3; ++d) sum += std::pow(gradient[d](i, j, k), 2);
      ++samples;
    });
  }
  const double bed = 0.56 * kind.density * gravity;
  return std::sqrt(sum / samples) / bed;
}

TEST(DriftingPacking, makes_little_noise_in_the_pressure_gradient) {
  Report report("drifting_packing",
                "rigid packing drifting with its gas: gradient of the pressure over the bed's");
  for (const auto& [grain, label] : {std::pair(5e-4, "0.5 mm"), std::pair(1e-3, "1.0 mm")}) {
    for (const std::string& mapping : mapping_names()) {
      const std::string quantity = mapping + "; grains of " + label;
      try {
        const double noise = gradient_noise(grain, mapping);
        if (mapping == "spline") {
          report.check(quantity, "cells of 1.25 mm", noise);
        } else {
          report.note(quantity, "cells of 1.25 mm", noise);
        }
      } catch (const UserError&) {  // no void is left in some cell
        EXPECT_NE(mapping, "spline");
        report.note(quantity + " (a void fraction below zero)", "cells of 1.25 mm",
                    std::numeric_limits<double>::infinity());
      }
    }
  }
}

// What the scheme converges to in one dimension: the bed of height `height` from the floor, spread
// by the Gaussian kernel K that the floor reflects; drag with kernel means of eps and u, spread by
// K. Pa.
double pressure_drop_of_kernel(double height, double sigma, double length, double diameter,
                               double solid_fraction, double velocity, const Gas& gas) {
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
  return "cell/d " + Column::format("%g", 5.0 / per_five, 0, 0);
}

double refined_pressure_drop(int per_five) {
  constexpr double d = refined_diameter, superficial = 0.01;
  const Column column{.upper = Vec3(0.01, 0.01, 0.06),
                      .cells = {2 * per_five, 2 * per_five, 12 * per_five},
                      .below = inlet(superficial),
                      .above = "type = \"outlet\", pressure = 0",
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
  const double exact = pressure_drop_of_kernel(0.03, 0.004, 0.06, 1e-4, M_PI / 6, 0.01, Gas{});
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
  const Column column{.upper = Vec3::Constant(20 * d),
                      .cells = {4 * per_five, 4 * per_five, 4 * per_five},
                      .below = inlet(rising),
                      .above = "type = \"outlet\", pressure = 0",
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

// Mean vertical gas force per grain over its weight.
double force_over_weight(const std::vector<Vec3>& forces, const GrainKind& kind) {
  double sum = 0;
  for (const Vec3& force : forces) sum += force[2];
  return sum / (double(forces.size()) * kind.mass() * gravity);
}

// Falls as one body from rest, driven by its weight and the mean gas force. `length` in lattice
// spacings. m/s.
double plug_velocity(const GrainKind& kind, double eps, const Gas& gas, int length) {
  const double s = lattice_spacing(kind.diameter(), 1 - eps);
  const Column column{
      .upper = s * Vec3(8, 8, length + 24), .cells = {4, 4, length / 2 + 12}, .gas = gas};
  const CoupledCase given = column.read();
  GasCoupling coupling(given.gas, given.options, MPI_COMM_SELF);
  std::vector<GrainRecord> grains = cubic(kind, Vec3(0, 0, 14.3 * s), {8, 8, length}, s);
  std::vector<Vec3> forces(grains.size());
  coupling.begin(forces, grains);
  const double relaxation =
      eps * eps * (1 - eps) * kind.density / ergun(eps, kind.diameter(), gas, 0.0);
  const double dt = 0.1 * relaxation;
  double velocity = 0;
  for (int step = 0; step < 80; ++step) {
    velocity += dt * gravity * (1 - force_over_weight(forces, kind));
    for (GrainRecord& grain : grains) {
      grain.velocity = Vec3(0, 0, -velocity);
      grain.position += dt * grain.velocity;
    }
    coupling.exchange(forces, grains, dt);
  }
  return velocity;
}

// In so thin a gas Ergun's quadratic term is below 1e-4 of the linear one. The kernel blurs the
// ends of the plug, where the gas gets past more easily: the shorter the plug, the faster, by a
// share that goes with the inverse of its length. Two lengths tell it apart.
TEST(RigidPlug, falls_in_a_closed_tube_as_fast_as_its_gas_gets_past) {
  Report report("rigid_plug", "rigid plug falling in a closed tube (mm/s)");
  const Gas thin{.density = 0.01};
  struct Row {
    GrainKind kind;
    double eps;
    std::string label;
  };
  for (const auto& [kind, eps, label] :
       {Row{{.original_diameter = 1.8e-4, .ratio = 1, .density = 1516}, 0.4122, "180 um 1516"},
        Row{{.original_diameter = 1e-4, .ratio = 1, .density = 1483}, 0.4073, "100 um 1483"}}) {
    const double half = plug_velocity(kind, eps, thin, 52);
    const double full = plug_velocity(kind, eps, thin, 104);
    report.note(label + " kg/m3; 50 d long", "4 x 4 x 38", 1e3 * half);
    report.note(label + " kg/m3; 100 d long", "4 x 4 x 64", 1e3 * full);
    report.check(label + " kg/m3; without the ends", "both", 1e3 * (2 * full - half));
  }
}

// Superficial velocity at which the gas carries a bed of eps = 0.40: where the line of the packed
// bed through two lower velocities meets the weight.
double fluidization_velocity(const GrainKind& kind, double guess) {
  const double s = lattice_spacing(kind.diameter(), 0.6);
  const auto carried = [&](double velocity) {
    const Column column{.upper = s * Vec3(8, 8, 128),
                        .cells = {4, 4, 64},
                        .below = inlet(velocity),
                        .above = "type = \"outlet\", pressure = 0",
                        .velocity = Vec3(0, 0, velocity)};
    const CoupledCase given = column.read();
    GasCoupling coupling(given.gas, given.options, MPI_COMM_SELF);
    const std::vector<GrainRecord> grains = cubic(kind, Vec3::Zero(), {8, 8, 104}, s);
    std::vector<Vec3> forces(grains.size());
    coupling.begin(forces, grains);
    for (int step = 0; step < 20; ++step) coupling.exchange(forces, grains, 1e-4);
    return force_over_weight(forces, kind);
  };
  const double low = carried(0.5 * guess), high = carried(0.9 * guess);
  return guess * (0.5 + 0.4 * (1 - low) / (high - low));
}

TEST(MinimumFluidization, is_where_the_packed_line_meets_the_weight) {
  Report report("minimum_fluidization", "minimum fluidization velocity at eps = 0.40 (mm/s)");
  const std::array<std::pair<GrainKind, const char*>, 3> kinds{
      {{{.original_diameter = 1e-4, .ratio = 1, .density = 2500}, "100 um 2500 kg/m3"},
       {{.original_diameter = 1.8e-4, .ratio = 1, .density = 1516}, "180 um 1516 kg/m3"},
       {{.original_diameter = 1e-4, .ratio = 1, .density = 1483}, "100 um 1483 kg/m3"}}};
  for (const auto& [kind, label] : kinds) {
    const double viscous = ergun(0.4, kind.diameter(), Gas{}, 0.0);
    const double guess = 0.4 * 0.4 * 0.6 * kind.density * gravity / viscous;
    report.check(label, "4 x 4 x 64", 1e3 * fluidization_velocity(kind, guess));
  }
}

}  // namespace
}  // namespace gasgrain::coupling
