// Flow between two cylinders, the inner one turning (Couette): profile and torque.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/cfd/gas_fixture.hpp"

namespace gasgrain::cfd {
namespace {

using testing::bodies;
using testing::box_case;
using testing::set_sides;

constexpr double r1 = 0.2, r2 = 0.45, rate = 2.0, depth = 0.1;

// Azimuthal velocity between the cylinders, viscosity 1: A r + B/r.
double couette(double r) {
  const double b = rate * r1 * r1 * r2 * r2 / (r2 * r2 - r1 * r1);
  return b * (1.0 / r - r / (r2 * r2));
}

// On the inner cylinder; the outer receives the opposite.
double couette_torque() {
  return -4.0 * std::numbers::pi * depth * rate * r1 * r1 * r2 * r2 / (r2 * r2 - r1 * r1);
}

struct CouetteError {
  double velocity;      // 2-norm over the largest velocity
  double inner, outer;  // torque over the exact one, minus one
};

CouetteError rotating_cylinder(int cells) {
  GasCase c = box_case(Vec3(1, depth, 1), {cells, 1, cells});
  c.numerics.pressure_tolerance = 1e-6;
  set_sides(c, 1, BoundaryType::slip);
  // the centre off the grid lines in both directions
  c.bodies = bodies(
      "[[body]]\nname='roll'\ncylinder={point=[0.503,0,0.491],axis=[0,1,0],radius=0.2}\n"
      "motion={rotate={point=[0.503,0,0.491],axis=[0,-1,0],rate=2},surface_only=true}\n"
      "[[body]]\nname='jacket'\ntorque_point=[0.503,0,0.491]\n"
      "complement={cylinder={point=[0.503,0,0.491],axis=[0,1,0],radius=0.45}}\n");
  GasSolver solver(c, MPI_COMM_WORLD);
  while (solver.time() < 0.06) solver.advance(solver.largest_stable_step());
  std::vector<double> sums(2, 0.0);
  const Decomposition& blocks = solver.decomposition();
  const double h = 1.0 / cells;
  for_each_cell(solver.pressure().size(), [&](int i, int j, int k) {
    for (const int d : {0, 2}) {
      if (solver.walls().takes_part[d](i, j, k) == 0.0) continue;
      const Vec3 x =
          testing::cell_centre(blocks, i, j, k) - 0.5 * h * Vec3::Unit(d) - Vec3(0.503, 0, 0.491);
      const double r = std::hypot(x[0], x[2]);
      const double exact = (d == 0 ? -x[2] : x[0]) * couette(r) / r;
      const double error = solver.velocity()[d](i, j, k) - exact;
      sums[0] += error * error;
      sums[1] += 1.0;
    }
  });
  sum_over_ranks(blocks, sums);
  const auto torque = [&](int body) {
    const BodyLoad& load = solver.body_loads()[body];
    return -(load.friction_torque + load.pressure_torque)[1];
  };
  for (int b = 0; b < 2; ++b) {
    const BodyLoad& load = solver.body_loads()[b];
    std::printf("%d: f %.4e p %.4e force %.3e %.3e\n", b,
                load.friction_torque[1] / couette_torque(),
                load.pressure_torque[1] / couette_torque(), load.friction[0] + load.pressure[0],
                load.friction[2] + load.pressure[2]);
  }
  return {std::sqrt(sums[0] / sums[1]) / (rate * r1), torque(0) / couette_torque() - 1.0,
          -torque(1) / couette_torque() - 1.0};
}

TEST(RotatingCylinder, profile_and_torque_are_second_order) {
  for (int n : {16, 32, 64}) {
    const CouetteError e = rotating_cylinder(n);
    std::printf("%d %.4e %.4e %.4e\n", n, e.velocity, e.inner, e.outer);
  }
}

}  // namespace
}  // namespace gasgrain::cfd
