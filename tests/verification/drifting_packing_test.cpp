// What the mappings cost in noise of the pressure gradient.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "coupling/shared/error.hpp"
#include "tests/coupling/random_packing.hpp"
#include "tests/verification/gas_column.hpp"
#include "tests/verification/report.hpp"

namespace gasgrain::coupling {
namespace {

using verification::Report;

// A rigid random packing and the gas in it drift through the grid together: no slip, so the exact
// gradient of the pressure is zero. What is there instead comes from d(eps)/dt on the grid. Root
// mean square of |grad p| in the cells over the gradient that carries the bed.
double gradient_noise(double grain, const std::string& mapping) {
  constexpr double box = 0.01, interval = 1e-4;
  const Vec3 drift = 0.1 * Vec3(0.3, 0.2, 1.0).normalized();
  const GasColumn column{.gas = {.upper = Vec3::Constant(box),
                                 .cells = {8, 8, 8},
                                 .x = {"periodic", "periodic"},
                                 .z = {"periodic", "periodic"}},
                         .velocity = drift,
                         .coupling = "mapping = \"" + mapping + "\"\n"};
  const GrainKind kind{.original_diameter = 1e-4, .ratio = grain / 1e-4};
  std::vector<GrainRecord> grains;
  for (const Vec3& x : random_packing(10, 0.56, static_cast<int>(std::lround(1e-3 / grain))))
    grains.push_back(kind.record(grain * x, drift));
  const CoupledCase given = column.read();
  GasCoupling coupling(given.gas, given.options, MPI_COMM_SELF);
  std::vector<Vec3> forces(grains.size());
  coupling.begin(forces, grains);
  cfd::VectorField velocity, gradient;
  for (int d = 0; d < 3; ++d) velocity[d] = gradient[d] = cfd::Field({8, 8, 8});
  double sum = 0;
  int samples = 0;
  for (int step = 1; step <= 120; ++step) {
    for (GrainRecord& g : grains) g.position += interval * g.velocity;
    coupling.exchange(forces, grains, interval);
    if (step <= 20) continue;
    coupling.gas().sample_at_cells(velocity, gradient);
    cfd::for_each_cell({8, 8, 8}, [&](int i, int j, int k) {
      for (int d = 0; d < 3; ++d) sum += std::pow(gradient[d](i, j, k), 2);
      ++samples;
    });
  }
  const double bed = 0.56 * kind.density * gravity;
  return std::sqrt(sum / samples) / bed;
}

TEST(DriftingPacking, makes_little_noise_in_the_pressure_gradient) {
  Report report("drifting_packing",
                "rigid packing drifting with its gas: gradient of the pressure over the bed's");
  for (const auto& [grain, label] : {std::pair(5e-4, "0.5 mm"), std::pair(1e-3, "1.0 mm")}) {
    for (const std::string& mapping : mapping_names()) {
      const std::string quantity = mapping + "; grains of " + label;
      try {
        const double noise = gradient_noise(grain, mapping);
        if (mapping == "spline") {
          report.check(quantity, "cells of 1.25 mm", noise);
        } else {
          report.note(quantity, "cells of 1.25 mm", noise);
        }
      } catch (const UserError&) {  // no void is left in some cell
        EXPECT_NE(mapping, "spline");
        report.note(quantity + " (a void fraction below zero)", "cells of 1.25 mm",
                    std::numeric_limits<double>::infinity());
      }
    }
  }
}

}  // namespace
}  // namespace gasgrain::coupling
