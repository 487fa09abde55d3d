#include "coupling/monitors.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "coupling/bubbles.hpp"
#include "coupling_scene.hpp"
#include "tests/gas_case_text.hpp"
#include "tests/shared/error_checks.hpp"

namespace gasgrain::coupling {
namespace {

std::string box_case(const std::string& monitors) {
  const GasCaseText gas{.upper = Vec3(0.020, 0.010, 0.030),
                        .cells = {16, 8, 24},
                        .gas = {.density = 1.2},
                        .x = {"no-slip", "no-slip"},
                        .y = {"no-slip", "no-slip"},
                        .z = {"no-slip", "outlet"}};
  return gas.text() + monitors;
}

const GrainKind kind{.ratio = 5};

// A bed 20 mm high, without the grains for which `hole` says so.
template <class Hole>
std::vector<GrainRecord> bed(const Hole& hole) {
  std::vector<GrainRecord> grains;
  for (const GrainRecord& grain :
       lattice(kind, Vec3(0, 0, 0), Vec3(0.020, 0.010, 0.020), 0.0005, 0.0)) {
    if (!hole(grain.position)) grains.push_back(grain);
  }
  return grains;
}

struct Scene {
  CoupledCase given;
  GasCoupling coupling;
  DealtGrains grains;

  explicit Scene(std::vector<GrainRecord> all)
      : given(box_case("")),
        coupling(given.gas, given.options, MPI_COMM_WORLD),
        grains(std::move(all), MPI_COMM_WORLD) {
    coupling.begin(grains.forces, grains.mine());
  }

  Bubbles bubbles() const {
    BedMonitor monitor(coupling.gas(), coupling.deposition().open_fraction(), Vertical{});
    monitor.observe(coupling.void_fraction());
    return find_bubbles(coupling.gas(),
                        {coupling.deposition().open_fraction(), coupling.void_fraction()},
                        Vertical{}, {0.8, monitor.height()});
  }
};

double ball(double radius) {
  return 4.0 / 3.0 * M_PI * std::pow(radius, 3);
}

TEST(Bubbles, are_counted_and_measured) {
  const Vec3 first(0.005, 0.005, 0.008), second(0.015, 0.005, 0.012);
  const double radius = 0.0038;
  const Scene scene(bed(
      [&](const Vec3& x) { return (x - first).norm() < radius || (x - second).norm() < radius; }));
  const Bubbles found = scene.bubbles();
  EXPECT_EQ(found.count, 2);
  // a void of 0.8 lies within the hole by some part of the kernel's width, 0.96 mm
  EXPECT_LT(found.volume, 2 * ball(radius));
  EXPECT_GT(found.volume, 2 * ball(radius - 0.00096));
}

TEST(Bubbles, of_a_full_bed_and_of_one_that_is_open_to_the_top_are_none) {
  EXPECT_EQ(Scene(bed([](const Vec3&) { return false; })).bubbles().count, 0);
  const Scene open(bed([](const Vec3& x) {
    return std::abs(x[0] - 0.01) < 0.003 && std::abs(x[1] - 0.005) < 0.003 && x[2] > 0.005;
  }));
  EXPECT_EQ(open.bubbles().count, 0);
}

// A counter of crossings adds a grain's mass once, whatever the steps.
TEST(Monitors, mass_through_a_plane_adds_up_to_the_grain) {
  const FluxPlane plane{"plane", 1, 0.004};
  for (const double speed : {0.7, -0.7}) {
    GrainRecord grain = kind.record(Vec3(0, speed > 0 ? 0.003 : 0.005, 0), Vec3(0, speed, 0));
    double mass = 0.0;
    for (int n = 0; n < 40; ++n) {
      const double dt = n % 3 == 0 ? 1e-4 : 3e-5;
      grain.position += dt * grain.velocity;
      mass += mass_through(plane, grain, dt);
    }
    EXPECT_NEAR(mass, std::copysign(grain.mass, speed), 1e-12 * grain.mass);
  }
}

TEST(Monitors, fluxes_are_means_since_the_last_row) {
  const std::string plane = R"(
[coupling.monitor]
plane = [{name = "middle", direction = "z", position = 0.0101}]
)";
  const CoupledCase given(box_case(plane));
  GasCoupling coupling(given.gas, given.options, MPI_COMM_WORLD);
  std::vector<GrainRecord> all = bed([](const Vec3&) { return false; });
  for (GrainRecord& grain : all) grain.velocity = Vec3(0, 0, -0.05);
  DealtGrains grains(all, MPI_COMM_WORLD);
  coupling.begin(grains.forces, grains.mine());
  BedMonitor bed_monitor(coupling.gas(), coupling.deposition().open_fraction(), Vertical{});
  Monitors monitors(given.options.monitor);
  double before = 0.0, after = 0.0;  // kg above the plane
  for (const GrainRecord& grain : grains.all()) {
    if (grain.position[2] > 0.0101) before += grain.mass;
  }
  const double dt = 1e-3;
  for (int n = 0; n < 20; ++n) {
    for (GrainRecord& grain : grains.all()) grain.position += dt * grain.velocity;
    std::erase_if(grains.all(), [](const GrainRecord& grain) { return grain.position[2] < 0; });
    grains.forces.assign(grains.mine().size(), Vec3::Zero());
    coupling.exchange(grains.forces, grains.mine(), dt);
    monitors.note_exchange(coupling, dt);
  }
  for (const GrainRecord& grain : grains.all()) {
    if (grain.position[2] > 0.0101) after += grain.mass;
  }
  bed_monitor.observe(coupling.void_fraction());
  const std::vector<double> values = monitors.take(coupling, bed_monitor, {});
  const std::vector<std::string> names = monitors.names();
  ASSERT_EQ(values.size(), names.size());
  EXPECT_EQ(names.back(), "flux_down_middle");
  // 1 mm of bed went through; the grains within a diameter of the plane blur it
  EXPECT_NEAR(values.back() * 20 * dt, before - after, 0.2 * (before - after));
  EXPECT_NEAR(values.back(), 2500 * 0.0002 * 0.05 * M_PI / 6, 0.05 * values.back());
  EXPECT_EQ(values[values.size() - 2], 0.0);
  EXPECT_EQ(monitors.take(coupling, bed_monitor, {}).back(), 0.0);
}

TEST(Monitors, mixing_index_is_low_for_layers_and_high_for_a_chequerboard) {
  Scene scene(bed([](const Vec3&) { return false; }));
  const auto index = [&](const auto& label) {
    std::vector<double> labels;
    for (const GrainRecord& grain : scene.grains.mine()) labels.push_back(label(grain.position));
    return mixing_index(scene.coupling, scene.coupling.transfer().send_along(labels));
  };
  const auto cell = [](double x) { return static_cast<long>(std::floor(x / 0.0005)); };
  const double layered = index([](const Vec3& x) { return x[2] < 0.01 ? 1.0 : 0.0; });
  const double mixed =
      index([&](const Vec3& x) { return double((cell(x[0]) + cell(x[1]) + cell(x[2])) % 2); });
  // apart but for the kernel at the interface: standard deviation w of the kernel in 20 mm of bed
  // gives the mean of 4 c (1 - c) with c an error function, 4 w / sqrt(pi) / 20 mm
  const double blur = 4 * scene.coupling.kernel_width() / std::sqrt(M_PI) / 0.020;
  EXPECT_NEAR(layered, blur, 0.3 * blur);
  EXPECT_GT(mixed, 0.98);
  EXPECT_TRUE(std::isnan(index([](const Vec3&) { return 1.0; })));
}

TEST(Monitors, options_refuse_what_they_do_not_know) {
  const auto expect = [](const std::string& text, const std::string& part) {
    expect_contains(user_error([&] { CoupledCase{box_case("[coupling.monitor]\n" + text)}; }),
                    part);
  };
  expect("bubbles = 0.8", "coupling.monitor.bubbles: is not a known key");
  expect("bubble_void_fraction = 1.2", "bubble_void_fraction: is 1.2, but must be in");
  expect("mixing = 'up'", "mixing: is 'up', but must be one of");
  expect("plane = [{name = 'a', direction = 'z', position = 1.0}]",
         "position: is 1, but must be in");
  expect("plane = [{name = 'a', direction = 'z', position = 0.01, colour = 1}]",
         "colour: is not a known key");
  expect("plane = [{name = 'a b', direction = 'z', position = 0.01}]", "part of column names");
}

}  // namespace
}  // namespace gasgrain::coupling
