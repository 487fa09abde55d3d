// Energy of an elastic grain without friction that flies about in a closed cavity for 1e6 steps.
//
// The wall force is the gradient of a potential, so only the time integration may change the
// energy. Velocity Verlet does so when a contact begins and ends between two steps, by up to
// (omega dt)^2/4 of the energy of the approach, at random. With a step such that a contact lasts a
// whole number of steps, omega dt = 2 sin(pi/(2 N)), both errors of a head-on contact cancel
// exactly (positions at contact are samples of one sine, and half a period later its mirror image).
// So the step is Tc/20.02 here, and what is left is the field's and the curvature's.
//
// The drift is a random walk of as many steps as there are contacts; the change of a single contact
// (root of the mean square) tells more of the order in dt and of the field. Lengths in radii of the
// grain.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "coupling/shared/boolean_shapes.hpp"
#include "coupling/shared/primitives.hpp"
#include "tests/verification/grain_flight.hpp"
#include "tests/verification/report.hpp"

namespace gasgrain::verification {
namespace {

constexpr double half_size = 7.0;         // of the sampled box
constexpr double spacing = 0.25;          // a quarter of the radius
constexpr double largest_overlap = 0.01;  // of a head-on impact

// Of which `count` make a contact, in units of sqrt(m/k).
double step_of_whole_contacts(int count) {
  return 2.0 * std::sin(0.5 * std::numbers::pi / count);
}

// A round cavity of six radii.
Shape ball() {
  return make_complement(make_shape(Sphere{Vec3(0.03, -0.07, 0.05), 6.0}));
}

const Vec3 ring_centre(0.1, 0.2, -0.1), ring_axis = Vec3(1, 2, 3).normalized();

// Its hole is as wide as the grain.
Shape ring() {
  return make_shape(
      Torus{.center = ring_centre, .axis = ring_axis, .radius = 1.8, .tube_radius = 0.8});
}

// The cavity with this ring in its middle, which nowhere comes near the outer wall.
Shape ball_with_ring() {
  return make_union({ball(), ring()});
}

// The same with a ring that grows out of the wall: concave edges all around.
Shape ball_with_bump() {
  return make_union(
      {ball(), make_shape(Torus{
                   .center = ring_centre, .axis = ring_axis, .radius = 5.2, .tube_radius = 1.6})});
}

struct Drift {
  double largest;      // |E/E0 - 1| between contacts
  double per_contact;  // root of the mean square of its changes
  int contacts;
};

Drift energy_drift(const Shape& cavity, int steps_per_contact) {
  constexpr int steps = 1'000'000;
  const double step = step_of_whole_contacts(steps_per_contact);
  GrainFlight grain(cavity, {});
  grain.position = Vec3(0.1, 0.3, 3.6);
  grain.velocity = largest_overlap * Vec3(0.48, 0.6, 0.64);
  const double start = grain.kinetic_energy();
  Drift drift{};
  double last = 1.0, squares = 0.0;
  bool before = false;
  for (int n = 0; n < steps; ++n) {
    grain.step(step);
    const bool now = grain.touches();
    if (before && !now) {
      ++drift.contacts;
      const double energy = grain.kinetic_energy() / start;
      drift.largest = std::max(drift.largest, std::abs(energy - 1.0));
      squares += (energy - last) * (energy - last);
      last = energy;
    }
    before = now;
  }
  drift.per_contact = std::sqrt(squares / drift.contacts);
  return drift;
}

struct Field {
  std::string name;
  Shape shape;
};

std::vector<Field> fields_of(const Shape& cavity) {
  return {{"exact distance", cavity},
          {"quadratic", sampled(cavity, half_size, spacing, Interpolation::quadratic)},
          {"linear", sampled(cavity, half_size, spacing, Interpolation::linear)}};
}

// With steps of Tc/20, /40 and /200.
void measure(const std::string& report_name, const std::string& title, const Shape& cavity) {
  Report report(report_name, title);
  for (const Field& field : fields_of(cavity)) {
    for (const int steps_per_contact : {20, 40, 200}) {
      const Drift drift = energy_drift(field.shape, steps_per_contact);
      EXPECT_GT(drift.contacts, 10);
      const std::string grid = "Tc/" + std::to_string(steps_per_contact) + "; " +
                               std::to_string(drift.contacts) + " contacts";
      const std::string which = "; " + field.name +
                                (steps_per_contact == 20   ? ""
                                 : steps_per_contact == 40 ? "; half the step"
                                                           : "; a tenth");
      report.check("largest energy drift" + which, grid, drift.largest);
      report.check("change per contact" + which, grid, drift.per_contact);
    }
  }
}

TEST(WallEnergy, is_kept_in_a_round_cavity) {
  measure("wall_energy_sphere", "elastic grain in a round cavity; 1e6 steps", ball());
}

TEST(WallEnergy, is_kept_in_a_cavity_with_a_ring) {
  measure("wall_energy_ring", "elastic grain in a round cavity with a ring; 1e6 steps",
          ball_with_ring());
}

TEST(WallEnergy, is_kept_in_a_cavity_with_a_bump) {
  measure("wall_energy_bump", "elastic grain in a round cavity with a torus bump; 1e6 steps",
          ball_with_bump());
}

// Balls shot along the axis of a ring, up to 0.1 radii beside it, whose hole is exactly as wide as
// they are: the circle that touches them all around is the hardest place for a search of feet.
double change_of_energy_in_a_hole(const Shape& ring) {
  constexpr int shots = 60;
  constexpr double off_axis = 0.1, start = 1.6, slant = 0.05;
  const Vec3 u = ring_axis.unitOrthogonal(), v = ring_axis.cross(u);
  const double step = step_of_whole_contacts(20);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> share(-1.0, 1.0);
  const auto across = [&] {
    const double along_u = share(random);
    return Vec3(along_u * u + share(random) * v);
  };
  double squares = 0.0;
  for (int n = 0; n < shots; ++n) {
    GrainFlight grain(ring, {});
    grain.position = ring_centre - start * ring_axis + off_axis * across();
    grain.velocity = largest_overlap * (ring_axis + slant * across()).normalized();
    const double before = grain.kinetic_energy();
    do grain.step(step);
    while (grain.touches() || (grain.position - ring_centre).norm() < start);
    squares += std::pow(grain.kinetic_energy() / before - 1.0, 2);
  }
  return std::sqrt(squares / shots);
}

TEST(WallEnergy, changes_little_in_a_hole_as_wide_as_the_ball) {
  Report report("wall_energy_hole", "elastic balls through a ring as wide as they are; Tc/20");
  const Shape field = sampled(ring(), 3.0, spacing, Interpolation::quadratic);
  report.check("change of energy rms; exact distance", "60 shots",
               change_of_energy_in_a_hole(ring()));
  report.check("change of energy rms; quadratic", "60 shots", change_of_energy_in_a_hole(field));
}

}  // namespace
}  // namespace gasgrain::verification
