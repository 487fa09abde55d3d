// Flow between two cylinders, the inner one turning (Couette): profile and torque.
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

constexpr double r1 = 0.2, r2 = 0.45, rate = 2.0, depth = 0.1;
constexpr double settled = 0.06;  // s: ten times (r2 - r1)^2/(pi^2 nu)

// Azimuthal velocity between the cylinders: A r + B/r.
double couette(double r) {
  const double b = rate * r1 * r1 * r2 * r2 / (r2 * r2 - r1 * r1);
  return b * (1.0 / r - r / (r2 * r2));
}

// That the gas (viscosity 1) holds the inner cylinder back with, and drags the outer one.
double couette_torque() {
  return 4.0 * std::numbers::pi * depth * rate * r1 * r1 * r2 * r2 / (r2 * r2 - r1 * r1);
}

struct CouetteError {
  double velocity;      // 2-norm over that of the inner wall
  double inner, outer;  // torque over the exact one, minus one
};

CouetteError rotating_cylinder(int cells) {
  GasCase c = box_case(Vec3(1, depth, 1), {cells, 1, cells});
  c.numerics.pressure_tolerance = 1e-6;
  set_sides(c, 1, BoundaryType::slip);
  // the centre off the grid lines in both directions
  const Vec3 centre(0.503, 0, 0.491);
  c.bodies = bodies(
      "[[body]]\nname='roll'\ncylinder={point=[0.503,0,0.491],axis=[0,1,0],radius=0.2}\n"
      "motion={rotate={point=[0.503,0,0.491],axis=[0,-1,0],rate=2},surface_only=true}\n"
      "[[body]]\nname='jacket'\ntorque_point=[0.503,0,0.491]\n"
      "complement={cylinder={point=[0.503,0,0.491],axis=[0,1,0],radius=0.45}}\n");
  GasSolver solver(c, MPI_COMM_WORLD);
  while (solver.time() < settled) solver.advance(solver.largest_stable_step());
  std::vector<double> sums(2, 0.0);
  const Decomposition& blocks = solver.decomposition();
  const double h = 1.0 / cells;
  for_each_cell(solver.pressure().size(), [&](int i, int j, int k) {
    for (const int d : {0, 2}) {
      if (solver.walls().takes_part[d](i, j, k) == 0.0) continue;
      const Vec3 x = testing::cell_centre(blocks, i, j, k) - 0.5 * h * Vec3::Unit(d) - centre;
      const double r = std::hypot(x[0], x[2]);
      const double exact = (d == 0 ? -x[2] : x[0]) * couette(r) / r;
      sums[0] += std::pow(solver.velocity()[d](i, j, k) - exact, 2);
      sums[1] += 1.0;
    }
  });
  sum_over_ranks(blocks, sums);
  const auto torque = [&](int body) {
    const BodyLoad& load = solver.body_loads()[body];
    return (load.friction_torque + load.pressure_torque)[1];
  };
  // rotation about -y: the gas turns the jacket the same way
  return {std::sqrt(sums[0] / sums[1]) / (rate * r1), torque(0) / couette_torque() - 1.0,
          -torque(1) / couette_torque() - 1.0};
}

TEST(RotatingCylinder, profile_and_torque_converge_to_the_exact_ones) {
  Report report("rotating_cylinder", "inner one of two cylinders turns");
  const CouetteError a = rotating_cylinder(16), b = rotating_cylinder(32),
                     d = rotating_cylinder(64);
  report.note("velocity error", "16 x 16", a.velocity);
  report.note("velocity error", "32 x 32", b.velocity);
  report.check("velocity error", "64 x 64", d.velocity);
  report.check("order of the velocity", "16; 64", observed_order(a.velocity, d.velocity, 4.0));
  report.check("order of the torque", "16; 64", observed_order(a.inner, d.inner, 4.0));
  report.check("inner torque over exact", "64 x 64", 1.0 + d.inner);
  report.check("outer torque over exact", "64 x 64", 1.0 + d.outer);
}

}  // namespace
}  // namespace gasgrain::cfd
