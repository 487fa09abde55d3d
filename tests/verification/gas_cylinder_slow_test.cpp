// Flow past a cylinder: steady in a channel with the order of its drag, shedding vortices in a
// channel, and free.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/verification/cylinder_flow.hpp"
#include "tests/verification/flow_tools.hpp"
#include "tests/verification/report.hpp"

namespace gasgrain::verification {
namespace {

using cfd::GasSolver;

std::string label(int cells) {
  return "D/dx " + std::to_string(cells);
}

void run_to_steady_drag(const CylinderFlow& flow, GasSolver& solver, double tolerance) {
  advance_by(solver, 0.2 * flow.diameter / flow.speed);
  advance_until_steady(solver, flow.diameter / flow.speed, tolerance, 100,
                       [&] { return force_coefficients(flow, solver).drag; });
}

TEST(CylinderInChannel, steady_flow_at_re_20) {
  Report report("cylinder_2d1", "cylinder in a channel, Re 20 (2D-1)");
  constexpr double exact = 5.57953523;
  std::unique_ptr<GasSolver> solver;
  std::vector<double> errors;
  for (const int cells : {10, 20, 40}) {
    const CylinderFlow flow = channel_with_cylinder(cells, 0.2);
    solver = start(flow, solver.get());
    run_to_steady_drag(flow, *solver, 1e-5);
    const ForceCoefficients c = force_coefficients(flow, *solver);
    const auto state = [&](const char* quantity, double value) {
      cells == 40 ? report.check(quantity, label(cells), value)
                  : report.note(quantity, label(cells), value);
    };
    state("drag coefficient", c.drag);
    state("lift coefficient", c.lift);
    state("pressure difference (Pa)", pressure_difference(flow, *solver));
    state("wake length (m)", wake_length(flow, *solver));
    state("drag over that by control volume",
          c.drag / control_volume_coefficients(flow, *solver).drag);
    errors.push_back(std::abs(c.drag - exact));
  }
  report.note("order of the drag", "D/dx 10; 20", observed_order(errors[0], errors[1]));
  report.check("order of the drag", "D/dx 20; 40", observed_order(errors[1], errors[2]));
}

void record_trace(const Report& report, const Trace& trace) {
  std::vector<std::vector<double>> rows;
  for (std::size_t n = 0; n < trace.time.size(); n += 4) {
    rows.push_back({trace.time[n], trace.drag[n], trace.lift[n]});
  }
  report.curve("trace", {"time", "drag", "lift"}, rows);
}

TEST(CylinderInChannel, vortex_street_at_re_100) {
  Report report("cylinder_2d2", "cylinder in a channel, Re 100 (2D-2)");
  std::unique_ptr<GasSolver> solver;
  for (const int cells : {10, 20, 40}) {
    const CylinderFlow flow = channel_with_cylinder(cells, 1.0);
    solver = start(flow, solver.get());
    Trace trace;
    advance_by(*solver, cells == 10 ? 10.0 : 2.0);
    advance_and_record(trace, flow, *solver, 1.2);
    const double from = trace.time.front() + 0.3;  // the change of step has faded
    const Oscillation drag = oscillation_after(from, trace.time, trace.drag),
                      lift = oscillation_after(from, trace.time, trace.lift);
    const auto state = [&](const char* quantity, double value) {
      cells == 40 ? report.check(quantity, label(cells), value)
                  : report.note(quantity, label(cells), value);
    };
    state("largest drag coefficient", drag.largest);
    state("largest lift coefficient", lift.largest);
    state("Strouhal number", lift.frequency * flow.diameter / flow.speed);
    if (cells == 40) record_trace(report, trace);
  }
}

void report_steady_free_cylinder(const std::string& name, double reynolds_number) {
  Report report(name, "free cylinder, Re " + std::to_string(std::lround(reynolds_number)) +
                          ", grid 15 + 15 x 60 diameters");
  std::unique_ptr<GasSolver> solver;
  for (const int cells : {8, 16}) {
    const CylinderFlow flow = half_free_cylinder({reynolds_number, cells, 15, 15, 30});
    solver = start(flow, solver.get());
    if (cells == 8) advance_by(*solver, 30.0);
    run_to_steady_drag(flow, *solver, 1e-3);
    const auto state = [&](const char* quantity, double value) {
      cells == 16 ? report.check(quantity, label(cells), value)
                  : report.note(quantity, label(cells), value);
    };
    state("drag coefficient", force_coefficients(flow, *solver).drag);
    state("wake length over diameter", wake_length(flow, *solver));
  }
}

TEST(FreeCylinder, steady_flow_at_re_20) {
  report_steady_free_cylinder("free_cylinder_re_20", 20);
}

TEST(FreeCylinder, steady_flow_at_re_40) {
  report_steady_free_cylinder("free_cylinder_re_40", 40);
}

// A whole cylinder; a start from a skew flow makes it shed without delay.
TEST(FreeCylinder, vortex_street_at_re_100) {
  Report report("free_cylinder_re_100", "free cylinder, Re 100, grid 10 + 20 x 24 diameters");
  std::unique_ptr<GasSolver> solver;
  for (const int cells : {6, 12}) {
    const CylinderFlow flow = free_cylinder({100, cells, 10, 20, 12});
    const GasSolver* coarser = solver.get();
    auto finer = start(flow, coarser);
    if (coarser == nullptr) {
      finer->set_velocity([](const Vec3& x) {
        return Vec3(1.0, 0, 0.5 * std::exp(-0.5 * (x - Vec3(1.5, 0, 0)).squaredNorm()));
      });
    }
    solver = std::move(finer);
    advance_by(*solver, cells == 6 ? 80.0 : 15.0);
    Trace trace;
    advance_and_record(trace, flow, *solver, 20.0);
    const Oscillation lift = oscillation_after(0.0, trace.time, trace.lift),
                      drag = oscillation_after(0.0, trace.time, trace.drag);
    const auto state = [&](const char* quantity, double value) {
      cells == 12 ? report.check(quantity, label(cells), value)
                  : report.note(quantity, label(cells), value);
    };
    state("drag coefficient", drag.mean);
    state("Strouhal number", lift.frequency);
  }
}

}  // namespace
}  // namespace gasgrain::verification
