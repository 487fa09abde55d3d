// Gas through beds of resting grains: pressure drop, step independence, tightness of bodies, and
// the order of the volume-averaged equations with and without drag.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "cfd/fixed_bed.hpp"
#include "tests/cfd/gas_fixture.hpp"

namespace gasgrain::cfd {
namespace {

using testing::bodies;
using testing::box_case;
using testing::set_sides;
using testing::side;

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

class ErgunBed : public ::testing::TestWithParam<std::pair<double, double>> {};

TEST_P(ErgunBed, pressure_drop_is_that_of_the_correlation) {
  const auto [velocity, expected] = GetParam();
  GasCase c = column(Vec3(0.004, 0.004, 0.0156), {4, 4, 26}, velocity);
  c.gas = {.density = 10.0, .viscosity = 1.5e-3, .gravity = Vec3::Zero()};
  c.fixed_bed = {.present = true,
                 .void_fraction = 0.451335,
                 .diameter = 1e-3,
                 .lower = c.grid.lower,
                 .upper = c.grid.upper};
  EXPECT_NEAR(pressure_drop_after(c, 1e-4, 10), expected, 0.005 * expected);
}

INSTANTIATE_TEST_SUITE_P(Velocities, ErgunBed,
                         ::testing::Values(std::pair(0.002, 22.99), std::pair(0.01, 115.09),
                                           std::pair(0.02, 230.51)));

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
  const GasCase c = dense_bed(1e-4);
  const double reference = pressure_drop_after(c, 1e-5, 50);
  // 150 (1-eps)^2/eps^3 mu U/d^2 L: the viscous part of Ergun's law over 12 mm; the rest is below 1
  // %
  const double viscous = 150 * 0.58 * 0.58 / (0.42 * 0.42 * 0.42) * 1.8e-5 * 0.01 / 1e-8 * 0.012;
  EXPECT_NEAR(reference, viscous, 0.06 * viscous);
  for (const double dt : {1e-6, 1e-4}) {
    EXPECT_NEAR(pressure_drop_after(c, dt, 50), reference, 1e-3 * reference) << dt;
  }
}

TEST(DenseBed, no_gas_leaks_through_a_solid_inside) {
  for (const double dt : {1e-6, 1e-5, 1e-4}) {
    GasCase c = dense_bed(1e-4);
    // a shelf from the left side over half the width, two and a half cells thick
    c.bodies =
        bodies("[[body]]\nname='shelf'\nbox={lower=[-1,-1,0.0047],upper=[0.0051,1,0.0079]}\n");
    GasSolver solver(c, MPI_COMM_WORLD);
    const FixedBedDrag bed(solver);
    for (int n = 0; n < 20; ++n) {
      bed.update(solver);
      solver.advance(dt);
    }
    const double inflow = solver.side_flux(2, 0);
    const Block& block = solver.decomposition().block();
    const double area = 0.00125 * 0.00125;
    for (int layer = 4; layer <= 6;
         ++layer) {  // planes of faces inside the shelf: z = 5 ... 7.5 mm
      double through = 0.0, beside = 0.0;
      for_each_cell(block.size, [&](int i, int j, int k) {
        if (k + block.lower[2] != layer) return;
        const double flux = solver.void_fraction()(i, j, k) * solver.velocity()[2](i, j, k) * area *
                            solver.walls().open_area[2](i, j, k);
        (i + block.lower[0] < 4 ? through : beside) += flux;
      });
      EXPECT_LT(std::abs(sum_over_ranks(solver.decomposition(), through)), 1e-3 * inflow) << dt;
      EXPECT_NEAR(sum_over_ranks(solver.decomposition(), beside), inflow, 1e-3 * inflow) << dt;
    }
  }
}

// Method of manufactured solutions (case 1 of Lethe's volume-averaged solver): in the square
// [-1,1]^2, with sx = sin(pi x) and so on,
//   eps = 1/2 + 1/4 sx sz,  u = (-2 sx^2 sz cz, 2 sx cx sz^2),  p = sx sz,  nu = rho = 1,
// and the body force that makes it a solution with drag B u. The force enters as the momentum that
// grains bring, in the cells.
struct Manufactured {
  static constexpr double pi = std::numbers::pi;
  double sx, cx, sz, cz;
  Manufactured(double x, double z)
      : sx(std::sin(pi * x)), cx(std::cos(pi * x)), sz(std::sin(pi * z)), cz(std::cos(pi * z)) {}
  double eps() const { return 0.5 + 0.25 * sx * sz; }
  double u() const { return -2 * sx * sx * sz * cz; }
  double w() const { return 2 * sx * cx * sz * sz; }
  double p() const { return sx * sz; }
  // f = eps (u . grad) u + eps grad p - div(eps tau) + B u; div u = 0
  std::pair<double, double> force(double drag) const {
    const double c2x = cx * cx - sx * sx, s2x = 2 * sx * cx, c2z = cz * cz - sz * sz,
                 s2z = 2 * sz * cz;
    const double ex = 0.25 * pi * cx * sz, ez = 0.25 * pi * sx * cz;
    const double u_x = -2 * pi * s2x * sz * cz, u_z = -2 * pi * sx * sx * c2z;
    const double w_x = 2 * pi * c2x * sz * sz, w_z = -u_x;
    const double lap_u = -2 * pi * pi * c2x * s2z + 4 * pi * pi * sx * sx * s2z;
    const double lap_w = -4 * pi * pi * s2x * sz * sz + 2 * pi * pi * s2x * c2z;
    const double fx = eps() * (u() * u_x + w() * u_z + pi * cx * sz - lap_u) - 2 * ex * u_x -
                      ez * (u_z + w_x) + drag * u();
    const double fz = eps() * (u() * w_x + w() * w_z + pi * sx * cz - lap_w) - 2 * ez * w_z -
                      ex * (u_z + w_x) + drag * w();
    return {fx, fz};
  }
};

struct MmsError {
  double velocity, pressure;
};

MmsError manufactured_error(int cells, double drag) {
  const double h = 2.0 / cells;
  GasCase c = box_case(Vec3(1, h, 1), {cells, 1, cells});
  c.grid.lower = Vec3(-1, 0, -1);
  c.numerics.convection = Convection::central;
  c.numerics.pressure_tolerance = 1e-7;
  set_sides(c, 1, BoundaryType::slip);
  GasSolver solver(c, MPI_COMM_WORLD);
  const Decomposition& blocks = solver.decomposition();
  GrainPhase& grains = solver.grains();
  for_each_cell(blocks.block().size, [&](int i, int j, int k) {
    const Vec3 x = testing::cell_centre(blocks, i, j, k);
    const Manufactured exact(x[0], x[2]);
    const auto [fx, fz] = exact.force(drag);
    grains.void_fraction(i, j, k) = exact.eps();
    grains.momentum_exchange(i, j, k) = drag;
    grains.exchange_momentum[0](i, j, k) = fx;
    grains.exchange_momentum[2](i, j, k) = fz;
  });
  solver.accept_void_fraction_as_old();
  const double dt = 0.1 * h * h;
  for (double t = 0.0; t < 1.0; t += dt) solver.advance(dt);
  std::vector<double> sums(4, 0.0);
  for_each_cell(blocks.block().size, [&](int i, int j, int k) {
    const Vec3 x = testing::cell_centre(blocks, i, j, k);
    const Manufactured left(x[0] - 0.5 * h, x[2]), below(x[0], x[2] - 0.5 * h), centre(x[0], x[2]);
    sums[0] += std::pow(solver.velocity()[0](i, j, k) - left.u(), 2) * h * h;
    sums[1] += std::pow(solver.velocity()[2](i, j, k) - below.w(), 2) * h * h;
    const double difference = solver.pressure()(i, j, k) - centre.p();
    sums[2] += difference * difference * h * h;
    sums[3] += difference * h * h / 4.0;
  });
  sum_over_ranks(blocks, sums);
  return {std::sqrt(sums[0] + sums[1]), std::sqrt(sums[2] - 4.0 * sums[3] * sums[3])};
}

class Mms : public ::testing::TestWithParam<double> {};

TEST_P(Mms, volume_averaged_equations_are_second_order) {
  const MmsError a = manufactured_error(8, GetParam()), b = manufactured_error(16, GetParam()),
                 d = manufactured_error(32, GetParam());
  EXPECT_GT(std::log2(b.velocity / d.velocity), 1.85)
      << a.velocity << " " << b.velocity << " " << d.velocity;
  EXPECT_GT(std::log2(b.pressure / d.pressure), 1.7)
      << a.pressure << " " << b.pressure << " " << d.pressure;
}

INSTANTIATE_TEST_SUITE_P(Drag, Mms, ::testing::Values(0.0, 1e3, 1e5));

}  // namespace
}  // namespace gasgrain::cfd
