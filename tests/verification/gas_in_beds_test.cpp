// Gas through beds of resting grains: pressure drop, step independence and tightness of bodies.
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "cfd/fixed_bed.hpp"
#include "tests/cfd/gas_fixture.hpp"
#include "tests/verification/report.hpp"

namespace gasgrain::cfd {
namespace {

using testing::bodies;
using testing::box_case;
using testing::set_sides;
using testing::side;
using verification::Report;

std::string step_label(double dt) {
  std::ostringstream label;
  label << "dt " << dt << " s";
  return label.str();
}

// A column of gas along z with an inlet below and an outlet above.
GasCase column(const Vec3& upper, const Index3& cells, double superficial_velocity) {
  GasCase c = box_case(upper, cells);
  set_sides(c, 0, BoundaryType::slip);
  set_sides(c, 1, BoundaryType::slip);
  c.boundaries[2][0] = testing::inlet(Vec3(0, 0, superficial_velocity));
  c.boundaries[2][1] = side(BoundaryType::outlet);
  return c;
}

double pressure_drop_after(const GasCase& gas_case, double dt, int steps) {
  GasSolver solver(gas_case, MPI_COMM_WORLD);
  const FixedBedDrag bed(solver);
  for (int n = 0; n < steps; ++n) {
    bed.update(solver);
    solver.advance(dt);
  }
  return solver.side_pressure(2, 0);
}

TEST(FixedBed, pressure_drop_is_that_of_the_correlation) {
  Report report("fixed_bed", "fixed bed of uniform void fraction, Ergun");
  for (const auto& [velocity, label] :
       {std::pair(0.002, "0.002"), std::pair(0.01, "0.01"), std::pair(0.02, "0.02")}) {
    GasCase c = column(Vec3(0.004, 0.004, 0.0156), {4, 4, 26}, velocity);
    c.gas = {.density = 10.0, .viscosity = 1.5e-3, .gravity = Vec3::Zero()};
    c.fixed_bed = {.present = true,
                   .void_fraction = 0.451335,
                   .diameter = 1e-3,
                   .lower = c.grid.lower,
                   .upper = c.grid.upper};
    report.check(std::string("pressure drop at ") + label + " m/s (Pa)", "4 x 4 x 26",
                 pressure_drop_after(c, 1e-4, 10));
  }
}

// Gas and grains of table 1 of the paper, packed to eps = 0.42.
GasCase dense_bed(double grain) {
  GasCase c = column(Vec3(0.01, 0.00125, 0.02), {8, 1, 16}, 0.01);
  c.gas = {.density = 1.0, .viscosity = 1.8e-5, .gravity = Vec3(0, 0, -9.81)};
  c.fixed_bed = {.present = true,
                 .void_fraction = 0.42,
                 .diameter = grain,
                 .lower = Vec3::Zero(),
                 .upper = Vec3(0.01, 0.00125, 0.012)};
  return c;
}

TEST(DenseBed, pressure_drop_does_not_depend_on_the_step) {
  Report report("dense_bed_step", "dense bed of 100 um grains, pressure drop against the gas step");
  const GasCase c = dense_bed(1e-4);
  const double reference = pressure_drop_after(c, 1e-5, 50);
  // 150 (1-eps)^2/eps^3 mu U/d^2 L: the viscous part of Ergun's law over 12 mm; the rest is below
  // 1 %
  const double viscous = 150 * 0.58 * 0.58 / (0.42 * 0.42 * 0.42) * 1.8e-5 * 0.01 / 1e-8 * 0.012;
  EXPECT_NEAR(reference, viscous, 0.06 * viscous);
  for (const double dt : {1e-6, 1e-4}) {
    report.check("pressure drop over that at 1e-5 s", step_label(dt),
                 pressure_drop_after(c, dt, 50) / reference);
  }
}

// Largest flux through the shelf's inner faces, and largest loss beside it, over the inlet's flux.
struct Leak {
  double through = 0.0, beside = 0.0;
};

Leak leak_of(const GasSolver& solver, int first_layer, int last_layer) {
  Leak leak;
  const double inflow = solver.side_flux(2, 0), area = 0.00125 * 0.00125;
  const Decomposition& blocks = solver.decomposition();
  for (int layer = first_layer; layer <= last_layer; ++layer) {  // 4 to 6: z = 5 ... 7.5 mm
    double through = 0.0, beside = 0.0;
    for_each_cell(blocks.block().size, [&](int i, int j, int k) {
      if (k + blocks.block().lower[2] != layer) return;
      const double flux = solver.void_fraction()(i, j, k) * solver.velocity()[2](i, j, k) * area *
                          solver.walls().open_area[2](i, j, k);
      (i + blocks.block().lower[0] < 4 ? through : beside) += flux;
    });
    through = sum_over_ranks(blocks, through) / inflow;
    beside = sum_over_ranks(blocks, beside) / inflow;
    leak.through = std::max(leak.through, std::abs(through));
    leak.beside = std::max(leak.beside, std::abs(beside - 1.0));
  }
  return leak;
}

// A shelf from the left side over half the width, two and a half cells thick.
GasCase bed_with_shelf() {
  GasCase c = dense_bed(1e-4);
  c.bodies = bodies("[[body]]\nname='shelf'\nbox={lower=[-1,-1,0.0047],upper=[0.0051,1,0.0079]}\n");
  return c;
}

void advance_bed(GasSolver& solver, double dt) {
  const FixedBedDrag bed(solver);
  for (int n = 0; n < 20; ++n) {
    bed.update(solver);
    solver.advance(dt);
  }
}

TEST(DenseBed, no_gas_leaks_through_a_solid_inside) {
  Report report("leak", "leak through a solid shelf inside a dense bed");
  for (const double dt : {1e-6, 1e-5, 1e-4}) {
    GasSolver solver(bed_with_shelf(), MPI_COMM_WORLD);
    advance_bed(solver, dt);
    const Leak leak = leak_of(solver, 4, 6);
    report.check("flux through the solid over inlet flux", step_label(dt), leak.through);
    report.check("flux lost beside it over inlet flux", step_label(dt), leak.beside);
  }
}

// gamma = 1000 as in the paper. The plane in the middle of the shelf, whose faces are all solid.
TEST(DenseBed, leaks_through_a_solid_with_volume_forcing_the_more_the_longer_the_step) {
  Report report("volume_forcing_leak",
                "leak through a solid shelf inside a dense bed, volume forcing for comparison");
  for (const auto& [dt, label] :
       {std::pair(1e-6, "at 1e-6 s"), std::pair(1e-5, "at 1e-5 s"), std::pair(1e-4, "at 1e-4 s")}) {
    GasCase c = bed_with_shelf();
    c.numerics.immersed_boundary = BodyMethod::volume_forcing;
    GasSolver solver(c, MPI_COMM_WORLD);
    advance_bed(solver, dt);
    report.check(label, "8 x 16", leak_of(solver, 5, 5).through);
  }
}

}  // namespace
}  // namespace gasgrain::cfd
