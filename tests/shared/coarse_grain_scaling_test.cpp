#include "coupling/shared/coarse_grain_scaling.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "coupling/shared/error.hpp"

namespace gasgrain {
namespace {

// The pair of the reference collision: r0 = 50 um, 2500 kg/m^3, k = 50 N/m, e = 0.9, 0.1 m/s.
constexpr double spring = 50.0, restitution = 0.9, speed = 0.1;
const double mass = 4.0 / 3.0 * M_PI * std::pow(50e-6, 3) * 2500;
const double effective_mass = mass / 2;

struct Collision {
  double restitution, duration, overlap;
};

// Integrates one contact of a damped spring until the overlap is zero again (Runge-Kutta 4).
Collision collide(double m, double k, double eta) {
  double x = 0, v = speed, t = 0, largest = 0;
  const double dt = std::sqrt(m / k) / 2000;
  const auto acceleration = [&](double overlap, double rate) {
    return -(k * overlap + eta * rate) / m;
  };
  while (true) {
    const double a1 = acceleration(x, v);
    const double a2 = acceleration(x + dt / 2 * v, v + dt / 2 * a1);
    const double a3 = acceleration(x + dt / 2 * (v + dt / 2 * a1), v + dt / 2 * a2);
    const double a4 = acceleration(x + dt * (v + dt / 2 * a2), v + dt * a3);
    const double x_new = x + dt * v + dt * dt / 6 * (a1 + a2 + a3);
    const double v_new = v + dt / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
    if (x_new <= 0) return {-v_new / speed, t + dt * x / (x - x_new), largest};
    x = x_new;
    v = v_new;
    t += dt;
    largest = std::max(largest, x);
  }
}

TEST(CoarseGrainScaling, DampingGivesTheRestitution) {
  for (const double e : {0.2, 0.5, 0.9, 0.99}) {
    const double eta = damping_coefficient(e, effective_mass, spring);
    EXPECT_NEAR(collide(effective_mass, spring, eta).restitution, e, 1e-3 * e);
  }
}

TEST(CoarseGrainScaling, ContactTimeIsThatOfTheIntegratedCollision) {
  const double eta = damping_coefficient(restitution, effective_mass, spring);
  const Collision collision = collide(effective_mass, spring, eta);
  EXPECT_NEAR(contact_time(restitution, effective_mass, spring), collision.duration,
              1e-4 * collision.duration);
  EXPECT_NEAR(contact_time(restitution, effective_mass, spring), 1.137e-5, 0.001e-5);
  EXPECT_NEAR(collision.overlap, 3.436e-7, 0.001e-7);
}

TEST(CoarseGrainScaling, ContactTimeIsTheFormulaOfTheHeader) {
  const double eta = damping_coefficient(restitution, effective_mass, spring);
  const double half_rate = eta / (2 * effective_mass);
  EXPECT_NEAR(contact_time(restitution, effective_mass, spring),
              M_PI / std::sqrt(spring / effective_mass - half_rate * half_rate), 1e-18);
}

TEST(CoarseGrainScaling, ElasticContactHasNoDamping) {
  EXPECT_EQ(damping_coefficient(1.0, effective_mass, spring), 0.0);
}

class ByRatioAndExponent : public testing::TestWithParam<std::tuple<double, double>> {};

TEST_P(ByRatioAndExponent, RestitutionIsKeptAndContactTimeAndOverlapScale) {
  const auto [ratio, exponent] = GetParam();
  const double eta = damping_coefficient(restitution, effective_mass, spring);
  const Collision original = collide(effective_mass, spring, eta);
  const Collision grain =
      collide(std::pow(ratio, 3) * effective_mass, grain_spring_constant(spring, ratio, {exponent}),
              grain_damping_coefficient(eta, ratio, {exponent}));
  EXPECT_NEAR(grain.restitution, original.restitution, 1e-9);
  const double time_scale = std::pow(ratio, (3 - exponent) / 2);
  EXPECT_NEAR(grain.duration / original.duration, time_scale, 1e-9 * time_scale);
  EXPECT_NEAR(grain.overlap / original.overlap, time_scale, 1e-9 * time_scale);
}

INSTANTIATE_TEST_SUITE_P(CoarseGrainScaling, ByRatioAndExponent,
                         testing::Combine(testing::Values(1.0, 5.0, 10.0),
                                          testing::Values(1.0, 2.0, 3.0)));

TEST(CoarseGrainScaling, SakaisLawScalesSpringAndDampingAsTheMass) {
  EXPECT_DOUBLE_EQ(grain_spring_constant(50, 5, {3.0}), 125 * 50);
  EXPECT_DOUBLE_EQ(grain_damping_coefficient(2e-5, 10, {3.0}), 1000 * 2e-5);
  EXPECT_DOUBLE_EQ(grain_spring_constant(50, 5, {1.0}), 5 * 50);
  EXPECT_DOUBLE_EQ(grain_damping_coefficient(2e-5, 5, {1.0}), 25 * 2e-5);
}

TEST(CoarseGrainScaling, RefusesValuesOutOfRange) {
  EXPECT_THROW(grain_spring_constant(50, 0.5, {3.0}), InternalError);
  EXPECT_THROW(grain_spring_constant(50, 2, {4.0}), InternalError);
  EXPECT_THROW(damping_coefficient(0.0, 1.0, 1.0), InternalError);
  EXPECT_THROW(contact_time(1.1, 1.0, 1.0), InternalError);
}

}  // namespace
}  // namespace gasgrain
