// The pure contact kernels against the exact solution of the damped spring and hand calculations.
#include "liggghts_plugins/contact_law.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "liggghts_plugins/contact_coefficients.hpp"
#include "liggghts_plugins/sphere_contact.hpp"

namespace gasgrain::plugins {
namespace {

constexpr double original_radius = 50e-6;  // m
constexpr double density = 2500;           // kg/m^3
constexpr double impact_speed = 0.1;       // m/s
constexpr OriginalContact glass{
    .spring_constant = 50, .restitution = 0.9, .friction_coefficient = 0.3};

double grain_mass(double l) {
  return density * 4.0 / 3.0 * std::numbers::pi * std::pow(l * original_radius, 3);
}

struct Impact {
  double largest_overlap = 0;  // m
  double largest_force = 0;    // N
  double duration = 0;         // s
  double restitution = 0;
};

// Two equal grains head-on, integrated with steps so small that the integrator does not matter.
Impact head_on(double l, double n) {
  const GrainContact contact(glass, {l, l}, {n});
  const double mass = grain_mass(l);
  const ContactCoefficients c = contact.between(mass, mass);
  const double dt = 1e-10;
  double overlap = 0, approach = impact_speed;
  Impact impact;
  do {
    const double force = normal_force(c, overlap, -approach);
    impact.largest_overlap = std::max(impact.largest_overlap, overlap);
    impact.largest_force = std::max(impact.largest_force, force);
    approach -= dt * force / (0.5 * mass);
    overlap += dt * approach;
    impact.duration += dt;
  } while (overlap > 0);
  impact.restitution = -approach / impact_speed;
  return impact;
}

TEST(ContactLaw, original_particle_impact_has_the_published_values) {
  const Impact impact = head_on(1, 3);
  EXPECT_NEAR(impact.largest_overlap, 3.436e-7, 0.001e-7);
  EXPECT_NEAR(impact.largest_force, 1.722e-5, 0.001e-5);
  EXPECT_NEAR(impact.duration, 1.137e-5, 0.001e-5);
  EXPECT_NEAR(impact.restitution, 0.9, 1e-4);
}

TEST(ContactLaw, exponent_3_keeps_overlap_and_contact_time) {
  const Impact original = head_on(1, 3);
  for (const double l : {5.0, 10.0}) {
    const Impact grain = head_on(l, 3);
    EXPECT_NEAR(grain.largest_overlap / original.largest_overlap, 1, 1e-9);
    EXPECT_NEAR(grain.duration / original.duration, 1, 1e-9);
    EXPECT_NEAR(grain.largest_force / original.largest_force, l * l * l, 1e-6);
    EXPECT_NEAR(grain.restitution, original.restitution, 1e-9);
  }
}

TEST(ContactLaw, exponent_1_keeps_relative_overlap) {
  const Impact original = head_on(1, 1);
  const Impact grain = head_on(5, 1);
  EXPECT_NEAR(grain.largest_overlap / original.largest_overlap, 5, 1e-3);
  EXPECT_NEAR(grain.duration / original.duration, 5, 1e-3);
  EXPECT_NEAR(grain.largest_force / original.largest_force, 25, 1e-2);
  EXPECT_NEAR(grain.restitution, 0.9, 1e-4);
}

TEST(ContactLaw, damping_scales_as_stated) {
  const double mass = grain_mass(1);
  for (const double n : {1.0, 2.0, 3.0}) {
    const double original =
        GrainContact(glass, {1, 1}, {n}).between(mass, mass).damping_coefficient;
    const double grain =
        GrainContact(glass, {4, 4}, {n}).between(64 * mass, 64 * mass).damping_coefficient;
    EXPECT_NEAR(grain / original, std::pow(4.0, 0.5 * (n + 3)), 1e-12);
  }
}

TEST(ContactLaw, unlike_ratios_reduce_to_the_law_for_equal_ones) {
  const double mass = grain_mass(5);
  const auto equal = GrainContact(glass, {5, 5}, {3}).between(mass, mass);
  const auto nearly = GrainContact(glass, {5, 5 * (1 + 1e-9)}, {3}).between(mass, mass);
  EXPECT_NEAR(nearly.spring_constant / equal.spring_constant, 1, 1e-8);
  EXPECT_NEAR(nearly.damping_coefficient / equal.damping_coefficient, 1, 1e-8);
}

TEST(ContactLaw, unlike_ratios_keep_the_contact_time_of_the_originals) {
  const double first = grain_mass(2), second = grain_mass(7);
  const auto c = GrainContact(glass, {2, 7}, {3}).between(first, second);
  const double effective = first * second / (first + second);
  const double original_effective = 0.5 * grain_mass(1);
  EXPECT_NEAR(c.spring_constant / effective, glass.spring_constant / original_effective, 1e-4);
  const auto exchanged = GrainContact(glass, {7, 2}, {3}).between(second, first);
  EXPECT_DOUBLE_EQ(exchanged.spring_constant, c.spring_constant);
}

TEST(ContactLaw, grain_against_a_wall_has_its_own_mass_as_effective_mass) {
  const double mass = grain_mass(5);
  const auto c = GrainContact(glass, {5, 5}, {3}).first_against_fixed(mass);
  const double ln_e = std::log(0.9), pi = std::numbers::pi;
  EXPECT_NEAR(c.spring_constant, 125 * 50, 1e-9);
  EXPECT_NEAR(c.damping_coefficient,
              -2 * ln_e * std::sqrt(mass * c.spring_constant / (pi * pi + ln_e * ln_e)), 1e-15);
}

constexpr ContactCoefficients rough{.spring_constant = 100,
                                    .damping_coefficient = 0,
                                    .tangential_spring_constant = 80,
                                    .tangential_damping = 0.5,
                                    .friction_coefficient = 0.3};

TEST(TangentialForce, sticks_with_spring_and_dashpot_below_the_friction_limit) {
  const auto f = tangential_spring_force(rough, 10, Vec3(0.01, 0, 0), Vec3(0, 2, 0));
  EXPECT_FALSE(f.sliding);
  EXPECT_NEAR((f.force - Vec3(-0.8, -1.0, 0)).norm(), 0, 1e-15);
}

TEST(TangentialForce, slides_along_the_spring_without_dashpot) {
  Vec3 displacement(0.03, 0.04, 0);  // spring 4 N, limit 3 N
  const auto f = tangential_spring_force(rough, -10, displacement, Vec3(0, 2, 0));
  EXPECT_TRUE(f.sliding);
  EXPECT_NEAR((f.force - Vec3(-1.8, -2.4, 0)).norm(), 0, 1e-14);
  const Vec3 cut = sliding_displacement(rough, f.force);
  EXPECT_NEAR(rough.tangential_spring_constant * cut.norm(), 3.0, 1e-14);
}

TEST(TangentialForce, history_stays_in_the_contact_plane) {
  Vec3 displacement(1e-6, 0, 0);
  const Vec3 n = Vec3(1, 2, 3).normalized();
  advance_tangential_displacement(displacement, Vec3(0, 1e-7, 0), n);
  EXPECT_NEAR(displacement.dot(n), 0, 1e-21);
}

TEST(TangentialForce, keeping_the_history_leaves_it_untouched) {
  Vec3 displacement(0.03, 0.04, 0);
  const ContactState state{Vec3::UnitZ(), 0.1, Vec3(1, 0, 0), Vec3::Zero()};
  contact_force<TangentialModel::history>(rough, state, displacement, {History::keep, 1e-6});
  EXPECT_EQ(displacement, Vec3(0.03, 0.04, 0));
}

TEST(TangentialForce, without_history_the_dashpot_is_limited_by_friction) {
  EXPECT_NEAR((tangential_dashpot_force(rough, 10, Vec3(2, 0, 0)) - Vec3(-1, 0, 0)).norm(), 0,
              1e-15);
  EXPECT_NEAR((tangential_dashpot_force(rough, 10, Vec3(8, 0, 0)) - Vec3(-3, 0, 0)).norm(), 0,
              1e-15);
}

TEST(ContactState, rolling_without_slip_has_no_tangential_velocity) {
  const double lever = 0.01, spin = 3;
  // grain above a floor, rolling along x: omega about +y
  const ContactState state{Vec3::UnitZ(), 0, Vec3(lever * spin, 0, 0), lever * Vec3(0, spin, 0)};
  EXPECT_NEAR(tangential_velocity(state).norm(), 0, 1e-16);
}

TEST(ContactForce, friction_brakes_the_surface_and_turns_the_grain_into_rolling) {
  Vec3 displacement = Vec3::Zero();
  // sliding along +x without spin above a floor
  const ContactState state{Vec3::UnitZ(), 0.1, Vec3(1, 0, 0), Vec3::Zero()};
  const ContactForce f =
      contact_force<TangentialModel::history>(rough, state, displacement, {History::advance, 1.0});
  EXPECT_LT(f.force[0], 0);
  EXPECT_NEAR(f.force[2], 10, 1e-12);
  EXPECT_GT(f.moment[1], 0);  // omega about +y is rolling along +x
}

}  // namespace
}  // namespace gasgrain::plugins
