// Columns of gas with grains at given places, without a DEM code.
#pragma once

#include <string>
#include <vector>

#include "cfd/loops.hpp"
#include "tests/coupling/coupling_scene.hpp"
#include "tests/gas_case_text.hpp"

namespace gasgrain::coupling {

constexpr double gravity = 9.81;  // m/s^2, of the grains; the gas has no weight

struct GasColumn {
  GasCaseText gas;
  Vec3 velocity = Vec3::Zero();  // initial
  std::string coupling = {};     // keys of that section

  CoupledCase read() const {
    return CoupledCase(gas.text() + "[initial]\nvelocity = " + toml(velocity) +
                       "\n[numerics]\npressure_tolerance = 1e-9\n[coupling]\n" + coupling);
  }
};

// Grains on a cubic lattice of that spacing in a box of `count` places.
inline std::vector<GrainRecord> cubic(const GrainKind& kind, const Vec3& lower,
                                      const cfd::Index3& count, double spacing) {
  std::vector<GrainRecord> grains;
  cfd::for_each_cell(count, [&](int i, int j, int k) {
    grains.push_back(kind.record(lower + spacing * Vec3(i + 0.5, j + 0.5, k + 0.5), Vec3::Zero()));
  });
  return grains;
}

}  // namespace gasgrain::coupling
