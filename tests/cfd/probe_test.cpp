// Probes against fields that are known in closed form.
#include "cfd/probe.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/cfd/gas_fixture.hpp"
#include "tests/shared/error_checks.hpp"

namespace gasgrain::cfd {
namespace {

using testing::bodies;
using testing::box_case;
using testing::set_sides;
using testing::side;

// Gas at rest on its weight: after a step p = rho g (upper - z), to the solver's tolerance.
GasCase column(const Index3& cells) {
  GasCase c = box_case(Vec3(1.0, 0.8, 1.2), cells);
  c.gas = {.density = 2.0, .viscosity = 0.1, .gravity = Vec3(0, 0, -10)};
  c.numerics.pressure_tolerance = 1e-13;
  set_sides(c, 0, BoundaryType::slip);
  set_sides(c, 1, BoundaryType::slip);
  c.boundaries[2][1] = side(BoundaryType::outlet);
  return c;
}

GasCase duct_with_ball() {
  GasCase c = column({10, 8, 12});
  c.gas.gravity = Vec3::Zero();
  c.boundaries[2][0] = testing::inlet(Vec3(0, 0, 0.5));
  c.bodies = bodies("[[body]]\nname='ball'\nsphere={center=[0.5,0.4,0.6],radius=0.25}\n");
  return c;
}

// What rank 0 has, on every rank.
std::vector<double> sampled(const Probe& probe, const GasSolver& solver) {
  std::vector<double> values = probe.sample(solver);
  MPI_Bcast(values.data(), static_cast<int>(values.size()), MPI_DOUBLE, 0, MPI_COMM_WORLD);
  return values;
}

std::vector<double> at_point(const GasSolver& solver, const Vec3& x) {
  return sampled(*make_point_probe({x}, solver.decomposition()), solver);
}

TEST(Probe, a_point_reads_a_linear_pressure_exactly_up_to_the_sides) {
  GasSolver solver(column({5, 4, 6}), MPI_COMM_WORLD);
  solver.advance(1e-2);
  for (const double z : {0.0, 0.03, 0.1, 0.57, 0.6, 1.1, 1.17, 1.2}) {
    for (const double x : {0.0, 0.42, 1.0}) {
      const std::vector<double> values = at_point(solver, Vec3(x, 0.8, z));
      EXPECT_NEAR(values[3], 20.0 * (1.2 - z), 1e-9) << z;
      EXPECT_DOUBLE_EQ(values[4], 1.0);
    }
  }
}

TEST(Probe, a_point_reads_a_bilinear_velocity_exactly) {
  GasSolver solver(column({7, 6, 8}), MPI_COMM_WORLD);
  const auto velocity = [](const Vec3& x) {
    return Vec3(x[1] + 2 * x[2] * x[0], 1 - x[0] + x[1] * x[2], 3 * x[0] - x[1] * x[0]);
  };
  solver.set_velocity(velocity);
  for (const Vec3& x : {Vec3(0.31, 0.44, 0.52), Vec3(0.5, 0.4, 0.6), Vec3(0.77, 0.21, 0.93)}) {
    const std::vector<double> values = at_point(solver, x);
    for (int d = 0; d < 3; ++d) EXPECT_NEAR(values[d], velocity(x)[d], 1e-13) << d;
  }
}

TEST(Probe, points_are_of_second_order) {
  const Vec3 x(0.37, 0.41, 0.53);
  const auto error = [&](int refinement) {
    GasSolver solver(column({10 * refinement, 8 * refinement, 12 * refinement}), MPI_COMM_WORLD);
    solver.set_velocity([](const Vec3& y) {
      return Vec3(std::sin(3 * y[1] + y[2]), std::cos(2 * y[0] + y[2]), std::sin(3 * y[0] * y[1]));
    });
    const Vec3 exact(std::sin(3 * x[1] + x[2]), std::cos(2 * x[0] + x[2]),
                     std::sin(3 * x[0] * x[1]));
    const std::vector<double> v = at_point(solver, x);
    return (Vec3(v[0], v[1], v[2]) - exact).norm();
  };
  EXPECT_GT(std::log(error(1) / error(4)) / std::log(4.0), 1.8);
}

TEST(Probe, a_point_at_a_wall_reads_the_wall) {
  GasCase c = column({5, 4, 6});
  set_sides(c, 0, BoundaryType::no_slip);
  c.boundaries[0][1].wall_velocity = Vec3(0, 0, 0.3);
  GasSolver solver(c, MPI_COMM_WORLD);
  solver.set_velocity([](const Vec3& x) { return Vec3(0, 0, 1.0 + x[0]); });
  EXPECT_NEAR(at_point(solver, Vec3(0, 0.4, 0.6))[2], 0.0, 1e-14);
  EXPECT_NEAR(at_point(solver, Vec3(1, 0.4, 0.6))[2], 0.3, 1e-14);
}

TEST(Probe, a_point_inside_a_body_has_no_value_and_one_beside_it_has_that_of_its_cell) {
  GasSolver solver(duct_with_ball(), MPI_COMM_WORLD);
  solver.advance(1e-3);
  for (const double value : at_point(solver, Vec3(0.5, 0.4, 0.6))) EXPECT_TRUE(std::isnan(value));
  for (const double value : at_point(solver, Vec3(0.5, 0.4, 0.3)))
    EXPECT_TRUE(std::isfinite(value));
}

TEST(Probe, the_flux_is_the_same_through_every_plane_of_a_duct) {
  GasSolver solver(duct_with_ball(), MPI_COMM_WORLD);
  for (int n = 0; n < 3; ++n) solver.advance(1e-3);
  for (const double z : {0.0, 0.04, 0.55, 0.6, 0.63, 1.2}) {
    const auto probe = make_plane_probe({2, z}, solver.decomposition());
    EXPECT_EQ(probe->columns()[0], "flux_m3_s");
    EXPECT_NEAR(sampled(*probe, solver)[0], 0.5 * 0.8, 1e-10) << z;
  }
  const auto across = make_plane_probe({0, 0.5}, solver.decomposition());
  EXPECT_NEAR(sampled(*across, solver)[0], 0.0, 1e-10);  // by symmetry
}

TEST(Probe, means_of_a_plane_are_those_of_its_position) {
  GasSolver solver(column({5, 4, 6}), MPI_COMM_WORLD);
  solver.advance(1e-2);
  for (const double z : {0.0, 0.31, 0.6, 1.2}) {
    const std::vector<double> row =
        sampled(*make_plane_probe({2, z}, solver.decomposition()), solver);
    EXPECT_NEAR(row[1], 0.8, 1e-14);  // open area
    EXPECT_NEAR(row[5], 20.0 * (1.2 - z), 1e-9);
    EXPECT_NEAR(row[6], 1.0, 1e-14);
  }
  const std::vector<double> side =
      sampled(*make_plane_probe({0, 0.3}, solver.decomposition()), solver);
  EXPECT_NEAR(side[5], 20.0 * 0.6, 1e-9);
}

TEST(Probe, planes_of_a_periodic_direction_join) {
  GasCase c = column({5, 4, 6});
  set_sides(c, 1, BoundaryType::periodic);
  GasSolver solver(c, MPI_COMM_WORLD);
  solver.set_velocity([](const Vec3&) { return Vec3(0, 0.7, 0); });
  for (const double y : {0.0, 0.35, 0.8}) {
    const auto probe = make_plane_probe({1, y}, solver.decomposition());
    EXPECT_NEAR(sampled(*probe, solver)[0], 0.7 * 1.2, 1e-13) << y;
  }
}

TEST(Probe, a_box_has_the_means_of_the_gas_in_it) {
  GasSolver solver(column({5, 4, 6}), MPI_COMM_WORLD);
  solver.advance(1e-2);
  const BoxProbe box{Vec3(0.1, 0.1, 0.3), Vec3(0.95, 0.7, 0.5)};  // cuts cells, half-way in z
  const std::vector<double> row = sampled(*make_box_probe(box, solver.decomposition()), solver);
  EXPECT_NEAR(row[0], 0.85 * 0.6 * 0.2, 1e-14);
  EXPECT_NEAR(row[4], 20.0 * (1.2 - 0.4), 1e-9);
  GasSolver with_ball(duct_with_ball(), MPI_COMM_WORLD);
  const BoxProbe all{Vec3::Zero(), Vec3(1.0, 0.8, 1.2)};
  const double open = sampled(*make_box_probe(all, with_ball.decomposition()), with_ball)[0];
  const double ball = 4.0 / 3.0 * M_PI * std::pow(0.25, 3);
  EXPECT_NEAR(open, 0.96 - ball, 0.03 * ball);
  const BoxProbe solid{Vec3(0.45, 0.35, 0.55), Vec3(0.55, 0.45, 0.65)};
  EXPECT_TRUE(std::isnan(sampled(*make_box_probe(solid, with_ball.decomposition()), with_ball)[4]));
}

TEST(Probe, a_line_has_a_row_per_sample_with_both_ends) {
  GasSolver solver(column({5, 4, 6}), MPI_COMM_WORLD);
  solver.advance(1e-2);
  const LineProbe line{Vec3(0, 0, 0), Vec3(0, 0.8, 0.6), 5};
  const auto probe = make_line_probe(line, solver.decomposition());
  const std::size_t columns = probe->columns().size();
  const std::vector<double> rows = sampled(*probe, solver);
  ASSERT_EQ(rows.size(), 5 * columns);
  for (int n = 0; n < 5; ++n) {
    const double* row = &rows[n * columns];
    EXPECT_NEAR(row[0], 0.25 * n, 1e-14);
    EXPECT_NEAR(row[3], 0.15 * n, 1e-14);
    EXPECT_NEAR(row[7], 20.0 * (1.2 - row[3]), 1e-9);
  }
}

TEST(Probe, of_a_body_is_its_load) {
  GasSolver solver(duct_with_ball(), MPI_COMM_WORLD);
  for (int n = 0; n < 3; ++n) solver.advance(1e-3);
  const std::vector<double> row = sampled(*make_body_probe({"ball", 0}), solver);
  const BodyLoad& load = solver.body_loads()[0];
  ASSERT_EQ(row.size(), make_body_probe({"ball", 0})->columns().size());
  EXPECT_EQ(row[2], load.pressure[2]);
  EXPECT_EQ(row[5], load.friction[2]);
  EXPECT_GT(row[2] + row[5], 0.0);  // downstream
}

std::string error_of(const std::string& probe) {
  const Grid grid{.lower = Vec3::Zero(), .upper = Vec3(1, 1, 1), .cells = {2, 2, 2}};
  return user_error([&] {
    read_probes(ConfigTable::parse(probe, "c.toml"), grid,
                bodies("[[body]]\nname='tube'\nsphere={center=[0,0,0],radius=0.2}\n"));
  });
}

TEST(ProbeCase, reads_every_kind) {
  EXPECT_EQ(error_of("[[probe]]\nname='a'\npoint=[0,0.5,1]\n[[probe]]\nname='b'\ninterval=0.1\n"
                     "line={from=[0,0,0],to=[1,1,1],samples=9}\n[[probe]]\nname='c'\n"
                     "plane={direction='y',position=0.5}\n[[probe]]\nname='d'\n"
                     "box={lower=[0,0,0],upper=[1,1,1]}\n[[probe]]\nname='e'\nbody='tube'\n"),
            "no error");
}

TEST(ProbeCase, says_what_is_wrong) {
  const auto expect = [](const std::string& probe, const std::string& part) {
    expect_contains(error_of("[[probe]]\n" + probe), part);
  };
  expect("name='a'\npoint=[0,0.5,1.1]", "outside the grid");
  expect("name='a'\nbody='tub'", "did you mean 'tube'");
  expect("name='a'", "must have exactly one of");
  expect("name='a'\nbody='tube'\npoint=[0,0,0]", "has 2 places");
  expect("name='../a'\npoint=[0,0,0]", "part of a file name");
  expect("name='a'\npoint=[0,0,0]\n[[probe]]\nname='a'\npoint=[0,0,0]", "used twice");
  expect("name='a'\nplane={direction='w',position=0}", "must be one of: x, y, z");
  expect("name='a'\nbox={lower=[0.5,0,0],upper=[0.5,1,1]}",
         "is (0.5, 1, 1), but must exceed lower = (0.5, 0, 0)");
  expect("name='a'\nline={from=[0,0,0],to=[1,1,1],sample=5}", "did you mean 'samples'");
}

}  // namespace
}  // namespace gasgrain::cfd
