#include "tests/verification/cylinder_flow.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "tests/verification/flow_tools.hpp"

namespace gasgrain::verification {

namespace {

using cfd::GasCase;
using cfd::GasSolver;

GasCase read_case(const std::ostringstream& toml) {
  return cfd::read_gas_case(ConfigTable::parse(toml.str(), "cylinder.toml"));
}

constexpr const char* sides_of_plane_flow = R"(
x_upper = {type = "outlet"}
y_lower = {type = "slip"}
y_upper = {type = "slip"}
)";

constexpr const char* numerics = R"(
[numerics]
convection = "central"
pressure_tolerance = 1e-4
)";

CylinderFlow in_free_stream(const FreeStream& s, double lower_z) {
  std::ostringstream toml;
  toml << "[grid]\nlower = [" << -s.before << ", 0, " << lower_z << "]\nupper = [" << s.behind
       << ", " << 1.0 / s.cells << ", " << s.beside << "]\ncells = ["
       << (s.before + s.behind) * s.cells << ", 1, " << std::lround((s.beside - lower_z) * s.cells)
       << "]\n[gas]\ndensity = 1\nviscosity = " << 1.0 / s.reynolds_number
       << "\n[boundary]\nx_lower = {type = \"inlet\", superficial_velocity = 1}"
       << sides_of_plane_flow << "z_lower = {type = \"slip\"}\nz_upper = {type = \"slip\"}\n"
       << numerics << "[[body]]\nname = \"cylinder\"\n"
       << "cylinder = {point = [0, 0, 0], axis = [0, 1, 0], radius = 0.5}\n";
  return {read_case(toml), 1.0, 1.0, Vec3::Zero(), lower_z == 0.0};
}

double depth(const CylinderFlow& flow) {
  return flow.gas_case.grid.upper[1] - flow.gas_case.grid.lower[1];
}

ForceCoefficients coefficients(const CylinderFlow& flow, const Vec3& force) {
  const double pressure = 0.5 * flow.gas_case.gas.density * flow.speed * flow.speed;
  const double area = flow.diameter * depth(flow);
  const double share = flow.half ? 2.0 : 1.0;
  return {share * force[0] / (pressure * area), force[2] / (pressure * area)};
}

}  // namespace

CylinderFlow channel_with_cylinder(int cells, double speed) {
  std::ostringstream toml;
  toml << "[grid]\nlower = [0, 0, 0]\nupper = [2.2, " << 0.1 / cells << ", 0.41]\ncells = ["
       << 22 * cells << ", 1, " << std::lround(4.1 * cells)
       << "]\n[gas]\ndensity = 1\nviscosity = 1e-3\n[boundary]\nx_lower = {type = \"inlet\", "
       << "superficial_velocity = " << speed
       << ", profile = \"parabolic\", profile_along = [\"z\"]}" << sides_of_plane_flow
       << "z_lower = {type = \"no-slip\"}\nz_upper = {type = \"no-slip\"}\n"
       << numerics << "[[body]]\nname = \"cylinder\"\n"
       << "cylinder = {point = [0.2, 0, 0.2], axis = [0, 1, 0], radius = 0.05}\n";
  return {read_case(toml), 0.1, speed, Vec3(0.2, 0, 0.2), false};
}

CylinderFlow free_cylinder(const FreeStream& stream) {
  return in_free_stream(stream, -stream.beside);
}

CylinderFlow half_free_cylinder(const FreeStream& stream) {
  return in_free_stream(stream, 0.0);
}

std::unique_ptr<GasSolver> start(const CylinderFlow& flow, const GasSolver* coarser) {
  auto solver = std::make_unique<GasSolver>(flow.gas_case, MPI_COMM_WORLD);
  if (coarser != nullptr) {
    solver->set_velocity(sampled_velocity(*coarser));
    return solver;
  }
  const bool in_channel = flow.gas_case.boundaries[2][0].type == cfd::BoundaryType::no_slip;
  const double height = flow.gas_case.grid.upper[2];
  solver->set_velocity([&](const Vec3& x) {
    const double s = x[2] / height;
    return Vec3(flow.speed * (in_channel ? 6.0 * s * (1.0 - s) : 1.0), 0, 0);
  });
  return solver;
}

ForceCoefficients force_coefficients(const CylinderFlow& flow, const GasSolver& solver) {
  const cfd::BodyLoad& load = solver.body_loads().front();
  return coefficients(flow, load.pressure + load.friction);
}

ForceCoefficients control_volume_coefficients(const CylinderFlow& flow, const GasSolver& solver) {
  const Vec3 reach(flow.diameter, 0, flow.diameter);
  return coefficients(flow, force_between(solver, flow.centre - reach, flow.centre + reach));
}

double pressure_difference(const CylinderFlow& flow, const GasSolver& solver) {
  const double h = solver.decomposition().grid().spacing()[0];
  const auto on_surface = [&](double side) {
    const auto outside = [&](double cells) {
      return pressure_at(solver,
                         flow.centre + Vec3(side * (0.5 * flow.diameter + cells * h), 0, 0));
    };
    // the parabola through three points outside the cells that the surface cuts
    return 4.375 * outside(1.5) - 5.25 * outside(2.5) + 1.875 * outside(3.5);
  };
  return on_surface(-1.0) - on_surface(1.0);
}

double wake_length(const CylinderFlow& flow, const GasSolver& solver) {
  const double h = solver.decomposition().grid().spacing()[0];
  const auto speed = [&](double behind) {
    return velocity_at(solver, 0, flow.centre + Vec3(0.5 * flow.diameter + behind, 0, 0));
  };
  const double end = flow.gas_case.grid.upper[0] - flow.centre[0] - flow.diameter;
  for (double x = 0.5 * h; x < end; x += 0.25 * h) {
    const double here = speed(x), next = speed(x + 0.25 * h);
    if (here < 0.0 && next >= 0.0) return x + 0.25 * h * here / (here - next);
  }
  return 0.0;
}

void advance_and_record(Trace& trace, const CylinderFlow& flow, GasSolver& solver,
                        double duration) {
  // equal steps, see advance_by; the flow is as fast as it gets when the recording starts
  const int steps = static_cast<int>(std::ceil(duration / (0.9 * solver.largest_stable_step())));
  for (int n = 0; n < steps; ++n) {
    solver.advance(duration / steps);
    const ForceCoefficients now = force_coefficients(flow, solver);
    trace.time.push_back(solver.time());
    trace.drag.push_back(now.drag);
    trace.lift.push_back(now.lift);
  }
}

}  // namespace gasgrain::verification
