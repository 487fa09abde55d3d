// Cases with everything that the equations have, and comparisons of two solvers.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "cfd/gas_solver.hpp"
#include "cfd/halo_exchange.hpp"
#include "cfd/loops.hpp"
#include "tests/cfd/gas_fixture.hpp"

namespace gasgrain::cfd::testing {

// Gas blown obliquely upwards through a box, with weight in two directions.
inline GasCase draught(const Vec3& upper, const Index3& cells) {
  GasCase c = box_case(upper, cells);
  c.gas = {.density = 1.2, .viscosity = 0.02, .gravity = Vec3(0.1, 0, -1.0)};
  c.boundaries[2][0] = inlet(Vec3(0.1, 0, 0.5));
  c.boundaries[2][1] = side(BoundaryType::outlet);
  return c;
}

// Flow upwards past two bodies, with everything the equations have.
inline GasCase tower() {
  GasCase c = draught(Vec3(1.0, 0.6, 2.0), {10, 6, 21});
  c.boundaries[0][0].wall_velocity = Vec3(0, 0.2, 0.1);
  set_sides(c, 1, BoundaryType::slip);
  c.boundaries[2][1].pressure = 3.0;
  c.bodies = bodies(
      "[[body]]\nname='a'\ncylinder={point=[0.32,0,0.7],axis=[0,1,0],radius=0.17}\n"
      "[[body]]\nname='b'\nsurface_velocity=[0,0.1,0]\nsphere={center=[0.7,0.3,1.2],radius=0.2}\n");
  return c;
}

// A closed bottle: gas only inside a tilted cylinder with a sphere in it, cut cells everywhere.
inline GasCase bottle() {
  GasCase c = box_case(Vec3(1.0, 1.0, 1.5), {12, 11, 15});
  c.gas = {.density = 1.2, .viscosity = 0.01, .gravity = Vec3(0, 0, -9.81)};
  c.numerics.pressure_tolerance = 1e-13;
  c.bodies = bodies(
      "[[body]]\nname='wall'\ncomplement={cylinder={start=[0.5,0.5,0.11],end=[0.53,0.5,1.37],"
      "radius=0.43}}\n"
      "[[body]]\nname='ball'\nsphere={center=[0.45,0.5,0.5],radius=0.12}\n");
  return c;
}

// Largest difference of the owned values of `field` to the same cells of one rank's whole `serial`.
inline double difference(const GasSolver& parallel, const Field& field, const Field& serial) {
  const Block& block = parallel.decomposition().block();
  double largest = 0.0;
  for_each_cell(block.size, [&](int i, int j, int k) {
    const double other = serial(i + block.lower[0], j + block.lower[1], k + block.lower[2]);
    largest = std::max(largest, std::abs(field(i, j, k) - other));
  });
  return max_over_ranks(parallel.decomposition(), largest);
}

// Ten steps with grains that move about.
inline void run_some_steps(GasSolver& solver) {
  set_moving_heap(solver, 0.0, 0.3, 40.0);
  solver.accept_void_fraction_as_old();
  for (int n = 1; n <= 10; ++n) {
    set_moving_heap(solver, 0.02 * n, 0.3, 40.0);
    solver.advance(1e-3);
  }
}

// Pressure and velocities agree to `tolerance` of the largest; `b` holds the whole grid.
inline void expect_equal_fields(const GasSolver& a, const GasSolver& b, double tolerance) {
  double speed = 0.0, pressure = 0.0;
  for_each_cell(a.pressure().size(), [&](int i, int j, int k) {
    pressure = std::max(pressure, std::abs(a.pressure()(i, j, k)));
    speed = std::max(speed, std::abs(a.velocity()[2](i, j, k)));
  });
  pressure = max_over_ranks(a.decomposition(), pressure);
  speed = max_over_ranks(a.decomposition(), speed);
  ASSERT_GT(speed, 0.1);
  EXPECT_LT(difference(a, a.pressure(), b.pressure()), tolerance * pressure);
  for (int d = 0; d < 3; ++d) {
    EXPECT_LT(difference(a, a.velocity()[d], b.velocity()[d]), tolerance * speed) << d;
  }
}

}  // namespace gasgrain::cfd::testing
