// A packing moves along an SDF wall in gas that was at rest (design: why the immersed boundary is
// blended by the drag). The true boundary layer at the wall is some micrometres thick, so next to
// no drag may remain on the grains at the wall once the packing has taken the gas with it. An
// immersed boundary at full strength leaves drag of the order of their weight.
#include <gtest/gtest.h>

#include <cmath>

#include "coupling_scene.hpp"
#include "tests/gas_case_text.hpp"

namespace gasgrain::coupling {
namespace {

// A wall off the grid lines; periodic along the motion. Cells of 1.25 mm.
std::string channel(double wall) {
  const GasCaseText gas{.lower = Vec3(-0.002, 0, 0),
                        .upper = Vec3(0.008, 0.005, 0.010),
                        .cells = {8, 4, 8},
                        .x = {"no-slip", "slip"},
                        .y = {"periodic", "periodic"},
                        .z = {"periodic", "periodic"}};
  return gas.text() + "[[body]]\nname = \"wall\"\nplane = {point = " + toml(Vec3(wall, 0, 0)) +
         ", normal = [1, 0, 0]}\n[numerics]\npressure_tolerance = 1e-10\n";
}

constexpr double speed = 0.1, weight_of_mass = 9.81;

struct Scene {
  double step;  // s
  double wall;  // place of the wall, m; the cell around it spans -0.75 to 0.5 mm
};

class MovingPacking : public testing::TestWithParam<Scene> {};

TEST_P(MovingPacking, has_no_gas_drag_next_to_the_wall) {
  const auto [dt, wall] = GetParam();
  const CoupledCase given(channel(wall));
  GasCoupling coupling(given.gas, given.options, MPI_COMM_SELF);
  const GrainKind kind{.ratio = 5};  // 0.5 mm
  // Cubic packing of void fraction 0.476, in contact with the wall.
  std::vector<GrainRecord> grains;
  for (int k = 0; k < 20; ++k)
    for (int j = 0; j < 10; ++j)
      for (int i = 0; i < 15; ++i) {
        grains.push_back(
            kind.record(Vec3(wall + 0.0005 * (i + 0.5), 0.0005 * (j + 0.5), 0.0005 * (k + 0.5)),
                        Vec3(0, 0, speed)));
      }
  std::vector<Vec3> forces(grains.size(), Vec3::Zero());
  coupling.begin(forces, grains);
  const int steps = std::max(100, static_cast<int>(std::lround(2e-3 / dt)));
  for (int step = 0; step < steps; ++step) {
    for (GrainRecord& grain : grains) grain.position += dt * grain.velocity;
    coupling.exchange(forces, grains, dt);
  }
  double largest = 0;
  for (std::size_t n = 0; n < grains.size(); ++n) {
    if (grains[n].position[0] > wall + 0.0005) continue;  // first layer
    largest = std::max(largest, std::abs(forces[n][2]));
  }
  EXPECT_LT(largest / (kind.mass() * weight_of_mass), 0.01);
  RecordProperty("drag_over_weight", std::to_string(largest / (kind.mass() * weight_of_mass)));
}

// The faces along the motion of the cell at the wall have their centres in the gas or in the solid,
// or the cell is a sliver.
INSTANTIATE_TEST_SUITE_P(Walls, MovingPacking,
                         testing::Values(Scene{1e-6, -0.0003}, Scene{5e-5, -0.0003},
                                         Scene{5e-5, -0.000135}, Scene{1e-6, 0.00003},
                                         Scene{5e-5, 0.00003}, Scene{1e-6, 0.00042},
                                         Scene{5e-5, 0.00042}));

}  // namespace
}  // namespace gasgrain::coupling
