// Gas that carries grains: a plug that falls through it, a bed at minimum fluidization.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "tests/verification/gas_column.hpp"
#include "tests/verification/report.hpp"

namespace gasgrain::coupling {
namespace {

using verification::Report;
using cfd::GasProperties;

// Spacing of a cubic lattice with that solid fraction.
double lattice_spacing(double diameter, double solid_fraction) {
  return diameter * std::cbrt(M_PI / 6 / solid_fraction);
}

// beta of Ergun's equation at a slip velocity, as eq 14.
double ergun(double eps, double diameter, const GasProperties& gas, double slip) {
  return 150 * (1 - eps) * (1 - eps) * gas.viscosity / (eps * diameter * diameter) +
         1.75 * (1 - eps) * gas.density * slip / diameter;
}

// Mean vertical gas force per grain over its weight.
double force_over_weight(const std::vector<Vec3>& forces, const GrainKind& kind) {
  double sum = 0;
  for (const Vec3& force : forces) sum += force[2];
  return sum / (double(forces.size()) * kind.mass() * gravity);
}

// Falls as one body from rest, driven by its weight and the mean gas force. `length` in lattice
// spacings. m/s.
double plug_velocity(const GrainKind& kind, double eps, const GasProperties& gas, int length) {
  const double s = lattice_spacing(kind.diameter(), 1 - eps);
  const GasColumn column{.gas = {.upper = s * Vec3(8, 8, length + 24),
                                 .cells = {4, 4, length / 2 + 12},
                                 .gas = gas,
                                 .x = {"periodic", "periodic"}}};
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
  const GasProperties thin{.density = 0.01};
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
    const GasColumn column{.gas = {.upper = s * Vec3(8, 8, 128),
                                   .cells = {4, 4, 64},
                                   .x = {"periodic", "periodic"},
                                   .z = {inlet(velocity), "outlet"}},
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
    const double viscous = ergun(0.4, kind.diameter(), GasProperties{}, 0.0);
    const double guess = 0.4 * 0.4 * 0.6 * kind.density * gravity / viscous;
    report.check(label, "4 x 4 x 64", 1e3 * fluidization_velocity(kind, guess));
  }
}

}  // namespace
}  // namespace gasgrain::coupling
