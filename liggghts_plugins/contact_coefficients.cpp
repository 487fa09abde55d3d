#include "liggghts_plugins/contact_coefficients.hpp"

#include <algorithm>

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
      ratios_(l),
      exponent_(n) {}

ContactCoefficients GrainContact::unlike_pair(double first_mass, double second_mass) const {
  const double first_original = first_mass / cube(ratios_.first);
  const double second_original = second_mass / cube(ratios_.second);
  const double effective = first_mass * second_mass / (first_mass + second_mass);
  const double effective_original =
      first_original * second_original / (first_original + second_original);
  // L lies between the two ratios; the bound only removes round-off
  const double ratio =
      std::max(std::cbrt(effective / effective_original), std::min(ratios_.first, ratios_.second));
  return of_effective_mass(effective,
                           grain_spring_constant(original_spring_constant_, ratio, exponent_));
}

}  // namespace gasgrain::plugins
