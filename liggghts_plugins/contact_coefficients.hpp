// From the properties of original particles to the contact coefficients of a pair of grains.
//
// Equal ratios l (eq 3-9): k -> l^n k, and eta from the restitution coefficient with the grains'
// own effective mass, which equals l^((n+3)/2) eta of the original pair.
//
// Unlike ratios: the pair takes the ratio L by which its effective mass grew,
//   L^3 = m_eff / m_eff_original,      k = L^n k_original,   eta = c(e) sqrt(m_eff k).
// For l_i = l_j this is the rule above; restitution is that of the original pair for any n, contact
// time is that of the original pair for n = 3, and one force acts on both grains, so momentum is
// conserved. For very unlike masses L tends to the ratio of the light grain, which moves.
#pragma once

#include <cmath>

#include "coupling/shared/coarse_grain_scaling.hpp"
#include "liggghts_plugins/contact_law.hpp"
#include "liggghts_plugins/surface_forces.hpp"

namespace gasgrain::plugins {

// Properties of a pair of original particles, or of an original particle and a wall.
struct OriginalContact {
  double spring_constant;                   // k, N/m
  double restitution;                       // e, (0, 1]
  double friction_coefficient;              // mu, -
  double tangential_stiffness_ratio = 1.0;  // k_t / k
  double tangential_damping_ratio = 1.0;    // eta_t / eta
  double work_of_adhesion = 0.0;            // w, J/m^2
  double rolling_friction = 0.0;            // mu_r, -
};

struct CoarseGrainRatios {
  double first;   // l_i
  double second;  // l_j; against a wall l_i again
};

// A grain as the surface forces of a contact need it.
struct GrainSize {
  double mass;    // kg
  double radius;  // m
};

// The part of the law that a pair of types fixes; one entry of a table over type pairs.
class GrainContact {
 public:
  GrainContact() = default;
  GrainContact(const OriginalContact& original, CoarseGrainRatios l, StiffnessExponent n);

  // Pair of grains of these masses, kg.
  ContactCoefficients between(double first_mass, double second_mass) const {
    const double effective_mass = first_mass * second_mass / (first_mass + second_mass);
    if (equal_ratios_) return of_effective_mass(effective_mass, spring_constant_);
    return unlike_pair(first_mass, second_mass);
  }

  // Grain of this mass against something that does not move (wall, frozen grain): m_eff = mass.
  ContactCoefficients first_against_fixed(double mass) const {
    return of_effective_mass(mass, first_fixed_spring_);
  }
  ContactCoefficients second_against_fixed(double mass) const {
    return of_effective_mass(mass, second_fixed_spring_);
  }

  bool has_surface_forces() const { return work_of_adhesion_ > 0.0 || rolling_friction_ > 0.0; }
  SurfaceForces surface_between(const GrainSize& first, const GrainSize& second) const;
  SurfaceForces surface_of_first_against_fixed(const GrainSize& grain) const;
  SurfaceForces surface_of_second_against_fixed(const GrainSize& grain) const;

 private:
  double ratio_of_unlike(double first_mass, double second_mass) const;
  SurfaceForces surface_of(double original_radius, double ratio) const;
  ContactCoefficients of_effective_mass(double mass, double k) const {
    const double eta = damping_factor_ * std::sqrt(mass * k);
    return {k, eta, tangential_stiffness_ratio_ * k, tangential_damping_ratio_ * eta,
            friction_coefficient_};
  }
  ContactCoefficients unlike_pair(double first_mass, double second_mass) const;

  bool equal_ratios_ = true;
  double spring_constant_ = 0;      // of the grains, N/m, when the ratios are equal
  double first_fixed_spring_ = 0;   // l_i^n k, N/m
  double second_fixed_spring_ = 0;  // l_j^n k, N/m
  double damping_factor_ = 0;       // eta / sqrt(m_eff k)
  double tangential_stiffness_ratio_ = 1;
  double tangential_damping_ratio_ = 1;
  double friction_coefficient_ = 0;
  double original_spring_constant_ = 0;  // N/m
  double work_of_adhesion_ = 0;          // J/m^2
  double rolling_friction_ = 0;
  CoarseGrainRatios ratios_{1, 1};
  StiffnessExponent exponent_;
};

}  // namespace gasgrain::plugins
