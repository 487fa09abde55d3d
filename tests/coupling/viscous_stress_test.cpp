// The viscous force on grains: V div(eps tau), which the gas loses.
#include <gtest/gtest.h>

#include "coupling_scene.hpp"
#include "tests/gas_case_text.hpp"

namespace gasgrain::coupling {
namespace {

constexpr double density = 10.0, viscosity = 1e-3, acceleration = 2.0;  // kg/m^3, Pa s, m/s^2

// Gas between two plates, driven along x by its weight.
std::string channel(const std::string& coupling) {
  const GasCaseText gas{
      .upper = Vec3(0.001, 0.001, 0.002),
      .cells = {4, 4, 16},
      .gas = {.density = density, .viscosity = viscosity, .gravity = Vec3(acceleration, 0, 0)},
      .x = {"periodic", "periodic"},
      .y = {"periodic", "periodic"}};
  return gas.text() + "[numerics]\npressure_tolerance = 1e-11\n[coupling]\n" + coupling;
}

// From the middle of the channel to a wall, all at one velocity.
std::vector<GrainRecord> row_of_grains() {
  const GrainKind kind{.original_diameter = 1e-4, .ratio = 1};
  std::vector<GrainRecord> grains;
  for (const double z : {1e-3, 1.3e-3, 1.6e-3, 1.8e-3, 1.94e-3})
    grains.push_back(kind.record(Vec3(0.0004, 0.0006, z), Vec3(0.02, 0.01, 0.03)));
  return grains;
}

std::vector<Vec3> forces_after(const std::string& coupling_options, int steps) {
  const CoupledCase given(channel(coupling_options));
  GasCoupling coupling(given.gas, given.options, MPI_COMM_WORLD);
  DealtGrains grains(row_of_grains(), MPI_COMM_WORLD);
  coupling.begin(grains.forces, grains.mine());
  for (int step = 0; step < steps; ++step) {
    const ExchangeReport report = coupling.exchange(grains.forces, grains.mine(), 2e-4);
    EXPECT_LT(report.third_law_residual, 1e-12);
  }
  return grains.forces;
}

// In steady flow mu d2u/dz2 = -rho g everywhere, next to the wall too: as if the grain's volume
// were gas.
TEST(ViscousStress, carries_the_weight_of_the_displaced_gas_in_a_channel) {
  const std::string one_way = "feedback = \"one-way\"\n";
  const int steps = 300;  // 15 times height^2/(pi^2 nu)
  const std::vector<Vec3> without = forces_after(one_way, steps);
  const std::vector<Vec3> with = forces_after(one_way + "viscous_stress = true\n", steps);
  const Vec3 expected(-density * acceleration * GrainKind{.ratio = 1}.volume(), 0, 0);
  for (std::size_t n = 0; n < with.size(); ++n)
    EXPECT_LT((with[n] - without[n] - expected).norm(), 1e-5 * expected.norm());
}

// The gas loses what the grains get; without feedback nothing would tell.
TEST(ViscousStress, is_taken_from_the_gas) {
  const std::vector<Vec3> without = forces_after("", 40);
  const std::vector<Vec3> with = forces_after("viscous_stress = true\n", 40);
  double change = 0.0;
  for (std::size_t n = 0; n < with.size(); ++n)
    change = std::max(change, (with[n] - without[n]).norm());
  MPI_Allreduce(MPI_IN_PLACE, &change, 1, MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
  EXPECT_GT(change, 0.3 * density * acceleration * GrainKind{.ratio = 1}.volume());
}

}  // namespace
}  // namespace gasgrain::coupling
