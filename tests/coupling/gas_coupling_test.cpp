#include "coupling/gas_coupling.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "cfd/loops.hpp"
#include "coupling/shared/error.hpp"
#include "coupling_scene.hpp"
#include "tests/gas_case_text.hpp"

namespace gasgrain::coupling {
namespace {

// A small bed with a tube in it, gas from below.
const GasCaseText bed_gas{.upper = Vec3(0.010, 0.005, 0.020),
                          .cells = {8, 4, 16},
                          .gas = {.density = 1.2, .gravity = Vec3(0, 0, -9.81)},
                          .x = {"no-slip", "slip"},
                          .y = {"no-slip", "no-slip"},
                          .z = {inlet(0.3), "outlet"}};
const std::string tube = R"([[body]]
name = "tube"
cylinder = {point = [0.0051, 0.0025, 0.0062], axis = [0, 1, 0], radius = 0.0021}
)";
const std::string bed = bed_gas.text() + tube + "[numerics]\npressure_tolerance = 1e-10\n";

// The same, closed on all sides and with a finer tolerance.
std::string closed_vessel() {
  GasCaseText gas = bed_gas;
  gas.x = gas.z = {"no-slip", "no-slip"};
  return gas.text() + tube + "[numerics]\npressure_tolerance = 1e-13\n";
}
const std::string vessel = closed_vessel();

// Grains of 0.5 mm that move at random around the tube.
std::vector<GrainRecord> bed_grains() {
  const GrainKind kind{.ratio = 5};
  std::vector<GrainRecord> grains;
  for (const GrainRecord& grain :
       lattice(kind, Vec3(0, 0, 0), Vec3(0.010, 0.005, 0.012), 0.00062, 0.2)) {
    const double distance =
        std::hypot(grain.position[0] - 0.0051, grain.position[2] - 0.0062) - 0.0021;
    if (distance > 0.00025) grains.push_back(grain);
  }
  return grains;
}

// Straight flight; those that would leave the vessel or enter the tube turn round.
void move(std::vector<GrainRecord>& grains, double dt) {
  const Vec3 lower = Vec3::Constant(0.00025), upper = Vec3(0.010, 0.005, 0.020) - lower;
  for (GrainRecord& grain : grains) {
    const Vec3 next = grain.position + dt * grain.velocity;
    const bool blocked = (next - lower).minCoeff() < 0 || (upper - next).minCoeff() < 0 ||
                         std::hypot(next[0] - 0.0051, next[2] - 0.0062) < 0.0021 + 0.00025;
    if (blocked) {
      grain.velocity = -grain.velocity;
    } else {
      grain.position = next;
    }
  }
}

TEST(GasCoupling, obeys_newtons_third_law) {
  const CoupledCase given(bed);
  GasCoupling coupling(given.gas, given.options, MPI_COMM_WORLD);
  DealtGrains grains(bed_grains(), MPI_COMM_WORLD);
  coupling.begin(grains.forces, grains.mine());
  for (const double dt : {1e-5, 5e-5, 2e-5, 1e-4, 1e-4}) {
    move(grains.all(), dt);
    const ExchangeReport report = coupling.exchange(grains.forces, grains.mine(), dt);
    EXPECT_EQ(report.gas_steps, 1);
    EXPECT_LT(report.third_law_residual, 1e-12);
    EXPECT_LT(report.pressure_residual, 1e-12);
    EXPECT_LT(report.solid_volume_residual, 1e-12);
    EXPECT_GT(report.force_on_grains[2], 0.0);
  }
}

// Whatever spreads the grains, the gas loses what they get.
TEST(GasCoupling, conserves_volume_and_momentum_with_every_mapping) {
  for (const std::string& mapping : mapping_names()) {
    const CoupledCase given(bed + "[coupling]\nmapping = \"" + mapping + "\"\n");
    GasCoupling coupling(given.gas, given.options, MPI_COMM_WORLD);
    DealtGrains grains(bed_grains(), MPI_COMM_WORLD);
    coupling.begin(grains.forces, grains.mine());
    for (int n = 0; n < 3; ++n) {
      move(grains.all(), 1e-4);
      const ExchangeReport report = coupling.exchange(grains.forces, grains.mine(), 1e-4);
      EXPECT_LT(report.third_law_residual, 1e-12) << mapping;
      EXPECT_LT(report.pressure_residual, 1e-12) << mapping;
      EXPECT_LT(report.solid_volume_residual, 1e-12) << mapping;
    }
  }
}

// The tube swings through the grains of a closed vessel.
TEST(GasCoupling, conserves_volume_and_momentum_around_a_moving_body) {
  const std::string text = vessel + R"(
[[body]]
name = "plunger"
sphere = {center = [0.0052, 0.0026, 0.0142], radius = 0.0017}
motion = {oscillate = {amplitude = [0.001, 0, 0.002], period = 0.02}}
)";
  const CoupledCase given(text);
  GasCoupling coupling(given.gas, given.options, MPI_COMM_WORLD);
  DealtGrains grains(bed_grains(), MPI_COMM_WORLD);
  coupling.begin(grains.forces, grains.mine());
  int steps = 0;
  for (int n = 0; n < 12; ++n) {
    const double dt = n % 3 == 2 ? 1e-3 : 2e-4;
    move(grains.all(), dt);
    const ExchangeReport report = coupling.exchange(grains.forces, grains.mine(), dt);
    steps += report.gas_steps;
    EXPECT_LT(report.third_law_residual, 1e-12) << n;
    EXPECT_LT(report.pressure_residual, 1e-12) << n;
    EXPECT_LT(report.solid_volume_residual, 1e-12) << n;
    EXPECT_LT(report.removed_mean, 1e-12) << n;
    EXPECT_LT(report.divergence, 1e-12) << n;
  }
  EXPECT_GT(steps, 12);
}

// The forces that arrive at the grains add up to what the report says.
TEST(GasCoupling, reports_the_sum_of_the_forces) {
  const CoupledCase given(bed);
  GasCoupling coupling(given.gas, given.options, MPI_COMM_WORLD);
  DealtGrains grains(bed_grains(), MPI_COMM_WORLD);
  coupling.begin(grains.forces, grains.mine());
  const ExchangeReport report = coupling.exchange(grains.forces, grains.mine(), 1e-4);
  Vec3 sum = Vec3::Zero();
  for (const Vec3& force : grains.forces) sum += force;
  MPI_Allreduce(MPI_IN_PLACE, sum.data(), 3, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
  EXPECT_LT((sum - report.force_on_grains).norm(), 1e-12 * sum.norm());
}

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

// Every rank computes the whole by itself as well and compares.
TEST(GasCoupling, does_not_depend_on_the_ranks) {
  const CoupledCase given(bed);
  GasCoupling together(given.gas, given.options, MPI_COMM_WORLD);
  GasCoupling alone(given.gas, given.options, MPI_COMM_SELF);
  DealtGrains dealt(bed_grains(), MPI_COMM_WORLD), own(bed_grains(), MPI_COMM_SELF);
  together.begin(dealt.forces, dealt.mine());
  alone.begin(own.forces, own.mine());
  for (int step = 0; step < 5; ++step) {
    move(dealt.all(), 5e-5);
    move(own.all(), 5e-5);
    together.exchange(dealt.forces, dealt.mine(), 5e-5);
    alone.exchange(own.forces, own.mine(), 5e-5);
  }
  double largest_force = 0, force_error = 0, largest_pressure = 0, pressure_error = 0;
  for (std::size_t n = 0; n < own.all().size(); ++n) {
    largest_force = std::max(largest_force, own.forces[n].norm());
    if (const Vec3* force = dealt.force(n)) {
      force_error = std::max(force_error, (*force - own.forces[n]).norm());
    }
  }
  const cfd::Block& block = together.gas().decomposition().block();
  double void_error = 0;
  cfd::for_each_cell(block.size, [&](int i, int j, int k) {
    const cfd::Index3 at{i + block.lower[0], j + block.lower[1], k + block.lower[2]};
    const double p = alone.gas().pressure()(at[0], at[1], at[2]);
    largest_pressure = std::max(largest_pressure, std::abs(p));
    pressure_error = std::max(pressure_error, std::abs(together.gas().pressure()(i, j, k) - p));
    void_error = std::max(void_error, std::abs(together.gas().void_fraction()(i, j, k) -
                                               alone.gas().void_fraction()(at[0], at[1], at[2])));
  });
  EXPECT_LT(force_error, 1e-8 * largest_force);
  EXPECT_LT(pressure_error, 1e-8 * largest_pressure);
  EXPECT_LT(void_error, 1e-12);
}

TEST(GasCoupling, sealed_vessel_with_grains_crossing_cut_cells_stays_divergence_free) {
  const CoupledCase given(vessel);
  GasCoupling coupling(given.gas, given.options, MPI_COMM_WORLD);
  DealtGrains grains(bed_grains(), MPI_COMM_WORLD);
  ExchangeReport report = coupling.begin(grains.forces, grains.mine());
  for (int step = 0; step < 20; ++step) {
    move(grains.all(), 1e-4);
    report = coupling.exchange(grains.forces, grains.mine(), 1e-4);
    EXPECT_LT(report.divergence, 1e-12);
    EXPECT_LT(report.removed_mean, 1e-12);
    EXPECT_GE(report.smallest_void_fraction, 0.2);
    EXPECT_EQ(report.limited, 0);
  }
}

TEST(GasCoupling, refuses_a_void_fraction_that_is_not_positive) {
  const CoupledCase given(bed);
  GasCoupling coupling(given.gas, given.options, MPI_COMM_WORLD);
  const GrainKind kind{.ratio = 10};
  std::vector<GrainRecord> heap(300, kind.record(Vec3(0.002, 0.0025, 0.015), Vec3::Zero()));
  DealtGrains grains(heap, MPI_COMM_WORLD);
  EXPECT_THROW(coupling.begin(grains.forces, grains.mine()), UserError);
}

}  // namespace
}  // namespace gasgrain::coupling
