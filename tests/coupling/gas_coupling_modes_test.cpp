// Exchanges over long intervals, of mixtures, one-way, and with grains beside the grid.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "coupling/gas_coupling.hpp"
#include "tests/coupling/small_bed.hpp"

namespace gasgrain::coupling {
namespace {

// Beyond the gas solver's largest step the interval is divided; the exchange stays exact.
TEST(GasCoupling, divides_a_long_interval_and_keeps_the_exchange_exact) {
  const CoupledCase given(bed);
  GasCoupling coupling(given.gas, given.options, MPI_COMM_WORLD);
  DealtGrains grains(bed_grains(), MPI_COMM_WORLD);
  coupling.begin(grains.forces, grains.mine());
  coupling.exchange(grains.forces, grains.mine(), 1e-4);
  const double interval = 3.5 * coupling.gas().largest_stable_step();
  move(grains.all(), interval);
  const ExchangeReport report = coupling.exchange(grains.forces, grains.mine(), interval);
  EXPECT_EQ(report.gas_steps, 4);
  EXPECT_LT(report.third_law_residual, 1e-12);
  EXPECT_LT(report.pressure_residual, 1e-12);
}

// Grains that cross cells within an interval leave no impulse where they were.
TEST(GasCoupling, keeps_the_exchange_exact_when_grains_cross_cells_in_a_long_interval) {
  const CoupledCase given(bed);
  GasCoupling coupling(given.gas, given.options, MPI_COMM_WORLD);
  std::vector<GrainRecord> above;
  for (GrainRecord& grain : bed_grains()) {
    if (grain.position[2] < 0.009) continue;
    grain.velocity = Vec3(0, 0, 2.0);
    above.push_back(grain);
  }
  DealtGrains grains(std::move(above), MPI_COMM_WORLD);
  coupling.begin(grains.forces, grains.mine());
  for (int n = 0; n < 5; ++n) {  // the last time some leave the grid
    const double interval = 1.2e-3;
    for (GrainRecord& grain : grains.all()) grain.position += interval * grain.velocity;
    const ExchangeReport report = coupling.exchange(grains.forces, grains.mine(), interval);
    EXPECT_GT(report.gas_steps, 1) << n;
    EXPECT_EQ(report.grains_outside > 0, n >= 3) << n;
    EXPECT_LT(report.third_law_residual, 1e-12) << n;
    EXPECT_LT(report.pressure_residual, 1e-12) << n;
    EXPECT_LT(report.solid_volume_residual, 1e-12) << n;
  }
}

// Grains that cannot move in a steady flow: what a shorter interval leaves over must not reach them
// as a force. Given back by the gas alone it comes as (1 - eps)(T' - T)/T' of theirs, about 0.2.
// Light grains (gas_density) feel the pressure gradient late.
double push_by_a_shorter_interval(double gas_density) {
  GasCaseText text = bed_gas;
  text.gas.density = gas_density;
  text.gas.gravity = Vec3::Zero();
  const CoupledCase given(text.text() + tube + "[numerics]\npressure_tolerance = 1e-10\n");
  GasCoupling coupling(given.gas, given.options, MPI_COMM_WORLD);
  DealtGrains grains(bed_grains(), MPI_COMM_WORLD);
  for (GrainRecord& grain : grains.all()) grain.velocity = Vec3::Zero();
  coupling.begin(grains.forces, grains.mine());
  const double interval = 2e-4, shorter = 0.75 * interval;
  for (int n = 0; n < 80; ++n) coupling.exchange(grains.forces, grains.mine(), interval);
  const std::vector<Vec3> before = grains.forces;
  for (std::size_t n = 0; n < grains.all().size(); ++n) {
    const Vec3* force = grains.force(n);
    if (force) grains.all()[n].carried = (shorter - interval) * *force;
  }
  const ExchangeReport report = coupling.exchange(grains.forces, grains.mine(), shorter);
  EXPECT_LT(report.third_law_residual, 1e-12);
  EXPECT_LT(report.pressure_residual, 1e-12);
  EXPECT_GT(report.carried.norm(), 0.2 * shorter * report.force_on_grains.norm());
  double sums[2] = {};  // of squares: change, force
  for (std::size_t n = 0; n < before.size(); ++n) {
    sums[0] += (grains.forces[n] - before[n]).squaredNorm();
    sums[1] += before[n].squaredNorm();
  }
  MPI_Allreduce(MPI_IN_PLACE, sums, 2, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
  return std::sqrt(sums[0] / sums[1]);
}

TEST(GasCoupling, does_not_push_a_packing_when_an_interval_is_shorter) {
  for (const double gas_density : {1.2, 1500.0}) {
    const double push = push_by_a_shorter_interval(gas_density);
    EXPECT_LT(push, 0.02) << gas_density;
    RecordProperty("at_density_" + std::to_string(static_cast<int>(gas_density)),
                   std::to_string(push));
  }
}

// The gas is faster between grains than at the inlet, which is all that is known at first.
TEST(GasCoupling, takes_shorter_steps_when_the_gas_gets_faster_within_an_interval) {
  const CoupledCase given(bed);
  GasCoupling coupling(given.gas, given.options, MPI_COMM_WORLD);
  DealtGrains grains(bed_grains(), MPI_COMM_WORLD);
  coupling.begin(grains.forces, grains.mine());
  const double at_rest = coupling.gas().largest_stable_step(), interval = 10 * at_rest;
  const ExchangeReport report = coupling.exchange(grains.forces, grains.mine(), interval);
  const double now = coupling.gas().largest_stable_step();
  EXPECT_LT(now, 0.7 * at_rest);
  EXPECT_GT(report.gas_steps, 0.8 * interval / now);
  EXPECT_DOUBLE_EQ(report.interval, interval);
}

// Equal grains are a mixture with d_m = d; of unlike ones momentum is exchanged as exactly.
TEST(GasCoupling, drags_mixtures_by_their_sauter_diameter) {
  const CoupledCase plain(bed), mixed(bed + "[coupling]\nmixture = \"sauter\"\n");
  std::vector<Vec3> forces[2];
  for (const CoupledCase* given : {&plain, &mixed}) {
    GasCoupling coupling(given->gas, given->options, MPI_COMM_WORLD);
    DealtGrains grains(bed_grains(), MPI_COMM_WORLD);
    coupling.begin(grains.forces, grains.mine());
    coupling.exchange(grains.forces, grains.mine(), 1e-4);
    forces[given == &mixed] = grains.forces;
  }
  double largest = 0.0;
  for (const Vec3& force : forces[0]) largest = std::max(largest, force.norm());
  for (std::size_t n = 0; n < forces[0].size(); ++n)
    EXPECT_LT((forces[1][n] - forces[0][n]).norm(), 1e-9 * largest);

  std::vector<GrainRecord> unlike = bed_grains();
  for (std::size_t n = 0; n < unlike.size(); n += 2) unlike[n].original_diameter *= 0.5;
  double drag[2];  // mean vertical force of the small ones
  for (const CoupledCase* given : {&plain, &mixed}) {
    GasCoupling coupling(given->gas, given->options, MPI_COMM_SELF);
    std::vector<Vec3> on_grains(unlike.size(), Vec3::Zero());
    coupling.begin(on_grains, unlike);
    const ExchangeReport report = coupling.exchange(on_grains, unlike, 1e-4);
    EXPECT_LT(report.third_law_residual, 1e-12);
    double sum = 0.0;
    for (std::size_t n = 0; n < unlike.size(); n += 2) sum += on_grains[n][2];
    drag[given == &mixed] = sum;
  }
  // a small grain feels less than in a bed of small grains: by (1 - eps)(1 - y), here about 7 %, of
  // the drag, which is most of the force
  EXPECT_LT(drag[1], 0.97 * drag[0]);
  EXPECT_GT(drag[1], 0.92 * drag[0]);
}

TEST(GasCoupling, one_way_leaves_the_gas_alone) {
  const CoupledCase given(bed + "[coupling]\nfeedback = \"one-way\"\n");
  GasCoupling coupling(given.gas, given.options, MPI_COMM_WORLD);
  DealtGrains grains(bed_grains(), MPI_COMM_WORLD);
  coupling.begin(grains.forces, grains.mine());
  const ExchangeReport report = coupling.exchange(grains.forces, grains.mine(), 1e-4);
  EXPECT_EQ(report.gas_momentum.drag.norm(), 0.0);
  EXPECT_EQ(report.smallest_void_fraction, 1.0);
  EXPECT_GT(report.force_on_grains.norm(), 0.0);
}

TEST(GasCoupling, counts_grains_outside_the_grid_and_gives_them_no_force) {
  const CoupledCase given(bed);
  GasCoupling coupling(given.gas, given.options, MPI_COMM_WORLD);
  std::vector<GrainRecord> all = bed_grains();
  const std::size_t stray = all.size();
  all.push_back(GrainKind{.ratio = 5}.record(Vec3(0.005, 0.0025, 0.03), Vec3(1, 1, 1)));
  DealtGrains grains(all, MPI_COMM_WORLD);
  const ExchangeReport report = coupling.begin(grains.forces, grains.mine());
  EXPECT_EQ(report.grains_outside, 1);
  EXPECT_EQ(report.grains_inside, static_cast<long>(stray));
  if (const Vec3* force = grains.force(stray)) {
    EXPECT_EQ(force->norm(), 0.0);
  }
}

}  // namespace
}  // namespace gasgrain::coupling
