// A single grain hovers in gas that rises at its terminal velocity (eq 15): values of an
// independent computation from the paper's drag law, gas of 1 kg/m^3 and 1.8e-5 Pa s.
#include <gtest/gtest.h>

#include <cmath>

#include "coupling_scene.hpp"
#include "tests/gas_case_text.hpp"

namespace gasgrain::coupling {
namespace {

struct Reference {
  double diameter, density, velocity;  // m, kg/m^3, m/s
};

const Reference references[] = {{1e-4, 2500, 0.5686}, {1.8e-4, 1516, 0.8885}, {1e-4, 1483, 0.3613}};

// A column of 8 x 8 x 8 cells, ten original diameters wide, gas from below.
std::string column(double cell, double gas_velocity, const std::string& feedback) {
  const GasCaseText gas{
      .upper = Vec3::Constant(8 * cell), .cells = {8, 8, 8}, .z = {inlet(gas_velocity), "outlet"}};
  return gas.text() + "[initial]\nvelocity = " + toml(Vec3(0, 0, gas_velocity)) +
         "\n[numerics]\npressure_tolerance = 1e-9\n[coupling]\nfeedback = \"" + feedback + "\"\n";
}

// Relative velocity of gas and grain when weight and gas force balance. The grain is held in the
// middle of the column (its place does not matter there) and only its velocity evolves.
double settling_velocity(const Reference& reference, double ratio, double cell,
                         const std::string& feedback) {
  const CoupledCase given(column(cell, reference.velocity, feedback));
  GasCoupling coupling(given.gas, given.options, MPI_COMM_SELF);
  const GrainKind kind{
      .original_diameter = reference.diameter, .ratio = ratio, .density = reference.density};
  const Vec3 place = Vec3(0.53, 0.48, 0.51) * 8 * cell;
  std::vector<GrainRecord> grain{kind.record(place, Vec3(0, 0, -0.05 * reference.velocity))};
  std::vector<Vec3> force(1, Vec3::Zero());
  coupling.begin(force, grain);
  const double dt = std::min(2e-3, coupling.gas().largest_stable_step());
  for (double time = 0; time < 0.6; time += dt) {
    grain[0].velocity[2] += dt * (force[0][2] / grain[0].mass - 9.81);
    coupling.exchange(force, grain, dt);
  }
  return reference.velocity - grain[0].velocity[2];
}

TEST(TerminalVelocity, of_an_original_particle_two_way) {
  for (const Reference& reference : references) {
    const double velocity = settling_velocity(reference, 1, 10 * reference.diameter, "two-way");
    EXPECT_NEAR(velocity / reference.velocity, 1.0, 0.005) << "d = " << reference.diameter;
    RecordProperty("relative_error", std::to_string(velocity / reference.velocity - 1));
  }
}

TEST(TerminalVelocity, of_a_grain_is_that_of_the_original) {
  for (const Reference& reference : references) {
    const double velocity = settling_velocity(reference, 10, 10 * reference.diameter, "one-way");
    EXPECT_NEAR(velocity / reference.velocity, 1.0, 0.005) << "d = " << reference.diameter;
  }
}

}  // namespace
}  // namespace gasgrain::coupling
