// Flow past a cylinder in a channel on coarse grids; the finer ones: gas_cylinder_slow_test.cpp.
#include <gtest/gtest.h>

#include "tests/verification/cylinder_flow.hpp"
#include "tests/verification/flow_tools.hpp"
#include "tests/verification/report.hpp"

namespace gasgrain::verification {
namespace {

TEST(CylinderInChannel, drag_at_re_20_on_a_coarse_grid) {
  Report report("cylinder_2d1_coarse",
                "cylinder in a channel, Re 20 (2D-1), 10 cells per diameter");
  const CylinderFlow flow = channel_with_cylinder(10, 0.2);
  const auto solver = start(flow, nullptr);
  advance_until_steady(*solver, 0.5, 1e-4, 30,
                       [&] { return control_volume_coefficients(flow, *solver).drag; });
  const double drag = force_coefficients(flow, *solver).drag;
  report.check("drag coefficient", "D/dx 10", drag);
  report.check("drag over that by control volume", "D/dx 10",
               drag / control_volume_coefficients(flow, *solver).drag);
}

}  // namespace
}  // namespace gasgrain::verification
