// Loads on bodies against the momentum budget and against statics.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/cfd/gas_scenes.hpp"

namespace gasgrain::cfd {
namespace {

using testing::bodies;
using testing::box_case;
using testing::set_moving_heap;
using testing::set_sides;

// Flow upwards past a cylinder and a sliding ball, grains moving about, one body for grains only.
GasCase column() {
  GasCase c = testing::draught(Vec3(1.0, 0.6, 2.0), {10, 6, 21});
  set_sides(c, 1, BoundaryType::slip);
  c.bodies = bodies(
      "[[body]]\nname='a'\ncylinder={point=[0.05,0,0.7],axis=[0,1,0],radius=0.17}\n"
      "[[body]]\nname='g'\nacts_on=['grains']\nplane={point=[0,0,0],normal=[0,0,1]}\n"
      "[[body]]\nname='b'\nsurface_velocity=[0,0.1,0]\nsphere={center=[0.7,0.3,1.7],radius=0.35}"
      "\n");
  return c;
}

TEST(BodyLoads, add_up_to_the_momentum_budget) {
  GasSolver solver(column(), MPI_COMM_WORLD);
  set_moving_heap(solver, 0.0, 0.3, 40.0);
  solver.accept_void_fraction_as_old();
  for (int n = 1; n <= 3; ++n) {
    const double dt = 1e-3 * n;
    set_moving_heap(solver, 0.05 * n, 0.3, 40.0);
    const MomentumBudget m = solver.advance(dt).momentum;
    const std::vector<BodyLoad>& loads = solver.body_loads();
    ASSERT_EQ(loads.size(), 3u);
    EXPECT_EQ(loads[1].pressure.norm() + loads[1].friction.norm(), 0.0);
    Vec3 pressure = Vec3::Zero(), friction = Vec3::Zero();
    for (const BodyLoad& load : loads) {
      pressure += load.pressure;
      friction += load.friction;
    }
    const double scale = testing::turnover(m);
    EXPECT_GT(dt * loads[0].pressure.norm(), 1e-3 * scale);
    EXPECT_GT(dt * loads[2].pressure.norm(), 1e-3 * scale);
    EXPECT_LT((dt * pressure + m.body_pressure).norm(), 1e-12 * scale);
    EXPECT_LT((dt * friction + m.body + m.body_stress).norm(), 1e-12 * scale);
  }
}

// In a box that is periodic all around nothing but the bodies can hold the gas.
TEST(BodyLoads, of_a_periodic_box_are_its_weight_minus_its_acceleration) {
  GasCase c = box_case(Vec3(1, 1, 1), {16, 16, 16});
  for (int d = 0; d < 3; ++d) set_sides(c, d, BoundaryType::periodic);
  c.gas = {.density = 1.5, .viscosity = 0.1, .gravity = Vec3(2.0, -1.0, 0.5)};
  c.numerics.convection = Convection::none;
  c.numerics.pressure_tolerance = 1e-12;
  c.bodies = bodies("[[body]]\nname='b'\nsphere={center=[0.52,0.43,0.51],radius=0.27}\n");
  GasSolver solver(c, MPI_COMM_WORLD);
  for (int n = 0; n < 20; ++n) {
    const double dt = 2e-3;
    const MomentumBudget m = solver.advance(dt).momentum;
    const BodyLoad& load = solver.body_loads()[0];
    const Vec3 received = dt * (load.pressure + load.friction);
    EXPECT_LT((received + m.stored - m.gravity).norm(), 1e-11 * m.gravity.norm());
  }
}

// Gas at rest under gravity lifts a body by the weight of the gas it displaces, with the torque of
// a force in the middle of its volume.
TEST(BodyLoads, of_resting_gas_are_its_buoyancy_at_the_middle_of_the_body) {
  GasCase c = box_case(Vec3(1, 1, 1), {20, 20, 20});
  c.gas = {.density = 1.5, .viscosity = 0.0, .gravity = Vec3(0.0, 0.0, -9.81)};
  c.numerics.pressure_tolerance = 1e-12;
  c.bodies = bodies(
      "[[body]]\nname='b'\ntorque_point=[0.1,0.2,0.3]\n"
      "sphere={center=[0.52,0.43,0.55],radius=0.27}\n");
  GasSolver solver(c, MPI_COMM_WORLD);
  solver.advance(1e-3);
  const double weight = 1.5 * 9.81 * 4.0 / 3.0 * std::numbers::pi * std::pow(0.27, 3);
  const BodyLoad& load = solver.body_loads()[0];
  EXPECT_LT((load.pressure - Vec3(0, 0, weight)).norm(), 0.01 * weight) << load.pressure;
  const Vec3 torque = Vec3(0.42, 0.23, 0.25).cross(Vec3(0, 0, weight));
  EXPECT_LT((load.pressure_torque - torque).norm(), 0.01 * torque.norm()) << load.pressure_torque;
  EXPECT_LT(load.friction.norm(), 1e-12 * weight);
}

}  // namespace
}  // namespace gasgrain::cfd
