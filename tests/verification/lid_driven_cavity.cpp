#include "tests/verification/lid_driven_cavity.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "tests/cfd/gas_fixture.hpp"
#include "tests/verification/flow_tools.hpp"
#include "tests/verification/report.hpp"

namespace gasgrain::verification {

namespace {

using cfd::BoundaryType;
using cfd::GasCase;
using cfd::GasSolver;

GasCase cavity(int cells, int reynolds_number) {
  GasCase c = cfd::testing::box_case(Vec3(1, 1.0 / cells, 1), {cells, 1, cells});
  c.gas.viscosity = 1.0 / reynolds_number;
  c.numerics.convection = cfd::Convection::central;
  c.numerics.pressure_tolerance = 1e-4;
  cfd::testing::set_sides(c, 1, BoundaryType::slip);
  c.boundaries[2][1].wall_velocity = Vec3(1, 0, 0);
  return c;
}

// Largest value of the parabola through the largest of `values` and its neighbours.
double largest_of_parabola(const std::vector<double>& values) {
  const auto n = std::max_element(values.begin() + 1, values.end() - 1);
  const double slope = 0.5 * (n[1] - n[-1]), bend = n[1] - 2.0 * n[0] + n[-1];
  return n[0] - 0.5 * slope * slope / bend;
}

// Velocity along the centre lines.
struct Profiles {
  std::vector<double> position;  // of u along z and of w along x
  std::vector<double> u, w;
};

Profiles profiles_of(const GasSolver& solver) {
  Profiles p;
  const int cells = solver.decomposition().grid().cells[0];
  for (int n = 0; n < cells; ++n) {
    const double s = (n + 0.5) / cells;
    p.position.push_back(s);
    p.u.push_back(velocity_at(solver, 0, Vec3(0.5, 0, s)));
    p.w.push_back(velocity_at(solver, 2, Vec3(s, 0, 0.5)));
  }
  return p;
}

struct Extremes {
  double u_min, w_max, w_min;
};

Extremes extremes_of(const Profiles& p) {
  const auto negative = [](std::vector<double> values) {
    for (double& v : values) v = -v;
    return values;
  };
  return {-largest_of_parabola(negative(p.u)), largest_of_parabola(p.w),
          -largest_of_parabola(negative(p.w))};
}

}  // namespace

void report_cavity(const std::string& name, int reynolds_number, const std::vector<int>& cells) {
  Report report(name, "lid-driven cavity, Re " + std::to_string(reynolds_number) + ", " +
                          std::to_string(cells.back()) + " cells");
  std::unique_ptr<GasSolver> solver;
  for (const int n : cells) {
    auto finer = std::make_unique<GasSolver>(cavity(n, reynolds_number), MPI_COMM_WORLD);
    if (solver) finer->set_velocity(sampled_velocity(*solver));
    solver = std::move(finer);
    advance_until_steady(*solver, 1.0, 1e-5, 150, [&] {
      const Extremes e = extremes_of(profiles_of(*solver));
      return e.w_max - e.w_min - e.u_min;
    });
    const Profiles profiles = profiles_of(*solver);
    const Extremes extremes = extremes_of(profiles);
    const std::string grid = std::to_string(n) + " x " + std::to_string(n);
    const bool finest = n == cells.back();
    const auto state = [&](const std::string& quantity, double value) {
      finest ? report.check(quantity, grid, value) : report.note(quantity, grid, value);
      if (finest && has_reference(name, quantity + " of Ghia")) {
        report.check(quantity + " of Ghia", grid, value);
      }
    };
    state("u_min", extremes.u_min);
    state("v_max", extremes.w_max);
    state("v_min", extremes.w_min);
    if (!finest) continue;
    std::vector<std::vector<double>> rows;
    for (int m = 0; m < n; ++m) {
      rows.push_back({profiles.position[m], profiles.u[m], profiles.w[m]});
    }
    report.curve("profiles", {"position", "u", "v"}, rows);
  }
}

}  // namespace gasgrain::verification
