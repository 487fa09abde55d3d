// Order of the volume-averaged equations with and without drag, by the method of manufactured
// solutions (case 1 of Lethe's volume-averaged solver): in the square [-1,1]^2, with
// sx = sin(pi x) and so on,
//   eps = 1/2 + 1/4 sx sz,  u = (-2 sx^2 sz cz, 2 sx cx sz^2),  p = sx sz,  nu = rho = 1,
// and the body force that makes it a solution with drag B u.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/cfd/gas_fixture.hpp"
#include "tests/verification/report.hpp"

namespace gasgrain::cfd {
namespace {

using verification::observed_order;
using verification::Report;

struct Manufactured {
  static constexpr double pi = std::numbers::pi;
  double sx, cx, sz, cz;
  explicit Manufactured(const Vec3& x)
      : sx(std::sin(pi * x[0])),
        cx(std::cos(pi * x[0])),
        sz(std::sin(pi * x[2])),
        cz(std::cos(pi * x[2])) {}
  double eps() const { return 0.5 + 0.25 * sx * sz; }
  Vec3 velocity() const { return {-2 * sx * sx * sz * cz, 0, 2 * sx * cx * sz * sz}; }
  double pressure() const { return sx * sz; }
  // f = eps (u . grad) u + eps grad p - div(eps tau) + B u; div u = 0
  Vec3 force(double drag) const {
    const double c2x = cx * cx - sx * sx, s2x = 2 * sx * cx, c2z = cz * cz - sz * sz,
                 s2z = 2 * sz * cz;
    const double ex = 0.25 * pi * cx * sz, ez = 0.25 * pi * sx * cz;
    const double u = velocity()[0], w = velocity()[2];
    const double u_x = -2 * pi * s2x * sz * cz, u_z = -2 * pi * sx * sx * c2z;
    const double w_x = 2 * pi * c2x * sz * sz, w_z = -u_x;
    const double lap_u = -2 * pi * pi * c2x * s2z + 4 * pi * pi * sx * sx * s2z;
    const double lap_w = -4 * pi * pi * s2x * sz * sz + 2 * pi * pi * s2x * c2z;
    return {eps() * (u * u_x + w * u_z + pi * cx * sz - lap_u) - 2 * ex * u_x - ez * (u_z + w_x) +
                drag * u,
            0,
            eps() * (u * w_x + w * w_z + pi * sx * cz - lap_w) - 2 * ez * w_z - ex * (u_z + w_x) +
                drag * w};
  }
};

// The force enters as the momentum that grains bring, which is given in the cells and shared half
// and half by their faces, or all by the one that is not on a side. The values in the cells of a
// row along x[direction] are chosen such that the force on each face is the exact one.
void set_force_row(GasSolver& solver, int direction, Index3 cell, double drag) {
  Field& force = solver.grains().exchange_momentum[direction];
  const Decomposition& blocks = solver.decomposition();
  const auto exact = [&](double steps) {
    Vec3 x = testing::cell_centre(blocks, cell[0], cell[1], cell[2]);
    x[direction] = blocks.grid().lower[direction] + steps * blocks.grid().spacing()[direction];
    return Manufactured(x).force(drag)[direction];
  };
  const int last = blocks.grid().cells[direction] - 1;
  double before = exact(0.5);
  cell[direction] = 0;
  force(cell[0], cell[1], cell[2]) = before;
  for (int n = 1; n <= last; ++n) {
    const double share_before = n == 1 ? 1.0 : 0.5, share = n == last ? 1.0 : 0.5;
    before = ((share_before + share) * exact(n) - share_before * before) / share;
    cell[direction] = n;
    force(cell[0], cell[1], cell[2]) = before;
  }
}

struct MmsError {
  double velocity, pressure;
};

// L2 norms over the square.
MmsError error_of(const GasSolver& solver, double h) {
  double velocity = 0.0, pressure = 0.0, mean = 0.0;
  for_each_cell(solver.pressure().size(), [&](int i, int j, int k) {
    const Vec3 x = testing::cell_centre(solver.decomposition(), i, j, k);
    for (const int d : {0, 2}) {
      const Manufactured exact(x - 0.5 * h * Vec3::Unit(d));
      velocity += std::pow(solver.velocity()[d](i, j, k) - exact.velocity()[d], 2) * h * h;
    }
    const double difference = solver.pressure()(i, j, k) - Manufactured(x).pressure();
    pressure += difference * difference * h * h;
    mean += difference * h * h / 4.0;
  });
  return {std::sqrt(velocity), std::sqrt(pressure - 4.0 * mean * mean)};
}

// With dt = share_of_diffusion h^2 / nu.
struct Stepping {
  Viscosity viscosity = Viscosity::explicit_step;
  double share_of_diffusion = 0.1;
};

// Of the steady state, reached from the exact solution.
MmsError manufactured_error(int cells, double drag, const Stepping& stepping = {}) {
  const double h = 2.0 / cells;
  GasCase c = testing::box_case(Vec3(1, h, 1), {cells, 1, cells});
  c.grid.lower = Vec3(-1, 0, -1);
  c.numerics.convection = Convection::central;
  c.numerics.pressure_tolerance = 1e-7;
  c.numerics.viscosity = stepping.viscosity;
  testing::set_sides(c, 1, BoundaryType::slip);
  GasSolver solver(c, MPI_COMM_WORLD);
  GrainPhase& grains = solver.grains();
  for_each_cell({cells, 1, cells}, [&](int i, int j, int k) {
    const Vec3 x = testing::cell_centre(solver.decomposition(), i, j, k);
    grains.void_fraction(i, j, k) = Manufactured(x).eps();
    grains.momentum_exchange(i, j, k) = drag;
  });
  for (int n = 0; n < cells; ++n) {
    set_force_row(solver, 0, {0, 0, n}, drag);
    set_force_row(solver, 2, {n, 0, 0}, drag);
  }
  solver.set_velocity([](const Vec3& x) { return Manufactured(x).velocity(); });
  solver.accept_void_fraction_as_old();
  const double dt = stepping.share_of_diffusion * h * h;
  for (double t = 0.0; t < 0.3; t += dt) solver.advance(dt);
  return error_of(solver, h);
}

struct DragCase {
  double drag;
  const char* name;
};

class Mms : public ::testing::TestWithParam<DragCase> {};

TEST_P(Mms, volume_averaged_equations_are_second_order) {
  const auto [drag, name] = GetParam();
  std::ostringstream title;
  title << "manufactured solution of the volume-averaged equations, drag coefficient " << drag;
  Report report(name, title.str());
  std::vector<MmsError> errors;
  for (const int cells : {16, 32, 64}) {
    const MmsError error = errors.emplace_back(manufactured_error(cells, drag));
    const std::string n = std::to_string(cells), grid = n + " x " + n;
    report.check("velocity error N=" + n, grid, error.velocity);
    report.check("pressure error N=" + n, grid, error.pressure);
  }
  for (const int n : {0, 1}) {
    const char* grids = n == 0 ? "16; 32" : "32; 64";
    report.check("velocity order", grids,
                 observed_order(errors[n].velocity, errors[n + 1].velocity));
    report.check("pressure order", grids,
                 observed_order(errors[n].pressure, errors[n + 1].pressure));
  }
}

INSTANTIATE_TEST_SUITE_P(Drag, Mms,
                         ::testing::Values(DragCase{0.0, "manufactured_no_drag"},
                                           DragCase{1e3, "manufactured_drag_1e3"},
                                           DragCase{1e5, "manufactured_drag_1e5"}));

// Ten times the largest explicit step: the stress is solved for, with the void fraction's gradient.
TEST(MmsWithImplicitViscosity, has_the_order_and_the_errors_of_explicit_viscosity) {
  constexpr Stepping implicit{Viscosity::implicit_step, 0.75};
  for (const double drag : {0.0, 1e3}) {
    const MmsError coarse = manufactured_error(16, drag, implicit);
    const MmsError fine = manufactured_error(32, drag, implicit);
    EXPECT_GT(observed_order(coarse.velocity, fine.velocity), 1.9) << drag;
    EXPECT_GT(observed_order(coarse.pressure, fine.pressure), 1.9) << drag;
    const MmsError explicit_viscosity = manufactured_error(32, drag);
    EXPECT_NEAR(fine.velocity, explicit_viscosity.velocity, 0.05 * fine.velocity) << drag;
    EXPECT_NEAR(fine.pressure, explicit_viscosity.pressure, 0.05 * fine.pressure) << drag;
  }
}

}  // namespace
}  // namespace gasgrain::cfd
