// Gas through a bed of real packed grains that rest, against Ergun's law applied layer by layer to
// the void fraction: -dp/dz = 150 (1-eps)^2/eps^3 mu U/d^2 + 1.75 (1-eps)/eps^3 rho U^2/d.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "tests/verification/gas_column.hpp"
#include "tests/verification/report.hpp"
#include "tests/verification/settled_packing.hpp"

namespace gasgrain::coupling {
namespace {

using verification::PackingScene;
using verification::Report;
using Layers = std::vector<double>;  // a value per layer of cells, from below

// Volume below z of a sphere about the origin.
double sphere_volume_below(double z, double diameter) {
  const double x = std::clamp(2 * z / diameter, -1.0, 1.0);
  return M_PI / 24 * std::pow(diameter, 3) * (2 + 3 * x - x * x * x);
}

// Of the spheres themselves: what the kernel knows nothing of.
Layers void_fractions_of_spheres(const std::vector<Vec3>& centres, const PackingScene& scene,
                                 int layers, double thickness) {
  Layers solid(layers, 0.0);
  for (const Vec3& centre : centres) {
    for (int n = 0; n < layers; ++n) {
      const double below = n * thickness - centre[2];
      solid[n] += sphere_volume_below(below + thickness, scene.diameter) -
                  sphere_volume_below(below, scene.diameter);
    }
  }
  const double wide = scene.width * scene.diameter;
  Layers result;
  for (const double volume : solid) result.push_back(1 - volume / (wide * wide * thickness));
  return result;
}

double ergun_gradient(double eps, double diameter, double velocity, const cfd::GasProperties& gas) {
  const double solid = 1 - eps, cube = eps * eps * eps;
  return 150 * solid * solid / cube * gas.viscosity * velocity / (diameter * diameter) +
         1.75 * solid / cube * gas.density * velocity * velocity / diameter;
}

struct GasInBed {
  double cell;           // m
  double pressure_drop;  // Pa, of the whole column
  Layers void_fraction, pressure;
  cfd::GasProperties gas;
  double kernel_width;  // m
};

GasInBed gas_through(const std::vector<Vec3>& centres, const PackingScene& scene, double velocity,
                     int cells_across) {
  const double wide = scene.width * scene.diameter, cell = wide / cells_across;
  const int layers = 8 * cells_across;
  const GasColumn column{.gas = {.upper = Vec3(wide, wide, layers * cell),
                                 .cells = {cells_across, cells_across, layers},
                                 .x = {"periodic", "periodic"},
                                 .y = {"periodic", "periodic"},
                                 .z = {inlet(velocity), "outlet"}},
                         .velocity = Vec3(0, 0, velocity)};
  const CoupledCase given = column.read();
  GasCoupling coupling(given.gas, given.options, MPI_COMM_SELF);
  const GrainKind kind{.original_diameter = scene.diameter, .ratio = 1};
  std::vector<GrainRecord> grains;
  for (const Vec3& centre : centres) grains.push_back(kind.record(centre, Vec3::Zero()));
  std::vector<Vec3> forces(grains.size());
  coupling.begin(forces, grains);
  for (int step = 0; step < 20; ++step) coupling.exchange(forces, grains, 1e-4);
  const cfd::GasSolver& gas = coupling.gas();
  GasInBed result{.cell = cell,
                  .pressure_drop = gas.side_pressure(2, 0) - gas.side_pressure(2, 1),
                  .void_fraction = Layers(layers, 0.0),
                  .pressure = Layers(layers, 0.0),
                  .gas = given.gas.gas,
                  .kernel_width = coupling.kernel_width()};
  const double share = 1.0 / (cells_across * cells_across);
  cfd::for_each_cell(coupling.void_fraction().size(), [&](int i, int j, int k) {
    result.void_fraction[k] += share * coupling.void_fraction()(i, j, k);
    result.pressure[k] += share * gas.pressure()(i, j, k);
  });
  return result;
}

// The kernel blurs the bed's surface, where gas gets through more easily then: half a kernel's
// width of the bed is lost. Away from the ends the law must hold for the spheres themselves; over
// the whole bed it must for the blurred void fraction that the gas sees.
TEST(PackedBed, pressure_drop_is_ergun_of_its_layers) {
  Report report("packed_bed", "fixed bed of settled grains, 60 d high: layer-wise Ergun");
  const PackingScene scene;
  const verification::Packing packing = verification::settled_packing(scene);
  EXPECT_LT(packing.speed, 0.005);  // m/s; they are held from here on
  double top = 0;
  for (const Vec3& centre : packing.centres) top = std::max(top, centre[2]);
  for (const double velocity : {0.02, 0.2}) {
    for (const int across : {4, 8}) {
      const GasInBed found = gas_through(packing.centres, scene, velocity, across);
      const int layers = static_cast<int>(found.pressure.size());
      const Layers spheres = void_fractions_of_spheres(packing.centres, scene, layers, found.cell);
      const auto law = [&](const Layers& eps, int n) {
        return found.cell * ergun_gradient(eps[n], scene.diameter, velocity, found.gas);
      };
      double blurred = 0, of_spheres = 0, inside = 0;
      for (int n = 0; n < layers; ++n) {
        blurred += law(found.void_fraction, n);
        of_spheres += law(spheres, n);
      }
      const int margin = static_cast<int>(std::ceil(4 * found.kernel_width / found.cell));
      const int last = static_cast<int>(top / found.cell) - margin;
      ASSERT_GT(last, 2 * margin);
      for (int n = margin; n < last; ++n) inside += 0.5 * (law(spheres, n) + law(spheres, n + 1));
      std::ostringstream label, grid;
      label << velocity << " m/s; cell/d " << found.cell / scene.diameter << "; ";
      grid << across << " x " << across << " x " << layers;
      report.check(label.str() + "away from the ends", grid.str(),
                   (found.pressure[margin] - found.pressure[last]) / inside);
      report.check(label.str() + "whole bed as the gas sees it", grid.str(),
                   found.pressure_drop / blurred);
      report.note(label.str() + "whole bed", grid.str(), found.pressure_drop / of_spheres);
    }
  }
}

}  // namespace
}  // namespace gasgrain::coupling
