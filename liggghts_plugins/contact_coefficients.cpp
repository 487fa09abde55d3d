#include "liggghts_plugins/contact_coefficients.hpp"

#include <algorithm>
#include <numbers>

namespace gasgrain::plugins {

namespace {

double cube(double value) {
  return value * value * value;
}

}  // namespace

GrainContact::GrainContact(const OriginalContact& original, CoarseGrainRatios l,
                           StiffnessExponent n)
    : equal_ratios_(l.first == l.second),
      spring_constant_(grain_spring_constant(original.spring_constant, l.first, n)),
      first_fixed_spring_(spring_constant_),
      second_fixed_spring_(grain_spring_constant(original.spring_constant, l.second, n)),
      damping_factor_(damping_coefficient(original.restitution, 1.0, 1.0)),
      tangential_stiffness_ratio_(original.tangential_stiffness_ratio),
      tangential_damping_ratio_(original.tangential_damping_ratio),
      friction_coefficient_(original.friction_coefficient),
      original_spring_constant_(original.spring_constant),
      work_of_adhesion_(original.work_of_adhesion),
      rolling_friction_(original.rolling_friction),
      ratios_(l),
      exponent_(n) {}

// L of the head of the header; the common ratio when they are equal.
double GrainContact::ratio_of_unlike(double first_mass, double second_mass) const {
  const double first_original = first_mass / cube(ratios_.first);
  const double second_original = second_mass / cube(ratios_.second);
  const double effective = first_mass * second_mass / (first_mass + second_mass);
  const double effective_original =
      first_original * second_original / (first_original + second_original);
  // L lies between the two ratios; the bound only removes round-off
  return std::max(std::cbrt(effective / effective_original),
                  std::min(ratios_.first, ratios_.second));
}

ContactCoefficients GrainContact::unlike_pair(double first_mass, double second_mass) const {
  const double effective = first_mass * second_mass / (first_mass + second_mass);
  const double ratio = ratio_of_unlike(first_mass, second_mass);
  return of_effective_mass(effective,
                           grain_spring_constant(original_spring_constant_, ratio, exponent_));
}

SurfaceForces GrainContact::surface_of(double original_radius, double ratio) const {
  const double growth = std::pow(ratio, 0.5 * (exponent_.value + 3.0));
  return {.adhesion = 2.0 * std::numbers::pi * work_of_adhesion_ * original_radius * growth,
          .rolling_friction = rolling_friction_};
}

SurfaceForces GrainContact::surface_between(const GrainSize& first, const GrainSize& second) const {
  const double a = first.radius / ratios_.first, b = second.radius / ratios_.second;
  const double ratio = equal_ratios_ ? ratios_.first : ratio_of_unlike(first.mass, second.mass);
  return surface_of(a * b / (a + b), ratio);
}

SurfaceForces GrainContact::surface_of_first_against_fixed(const GrainSize& grain) const {
  return surface_of(grain.radius / ratios_.first, ratios_.first);
}

SurfaceForces GrainContact::surface_of_second_against_fixed(const GrainSize& grain) const {
  return surface_of(grain.radius / ratios_.second, ratios_.second);
}

}  // namespace gasgrain::plugins
