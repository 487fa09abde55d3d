// Scaling of an original particle's contact law to a grain of ratio l (eq 3-9).
//
//   k_grain   = l^n k0,   eta_grain = l^((n+3)/2) eta0,   m_grain = l^3 m0
//
// The damping exponent is what keeps eta / sqrt(m k), and with it the restitution, independent of
// l: sqrt(l^3 l^n) = l^((n+3)/2). The contact time then grows as l^((3-n)/2): not at all for n = 3
// (Sakai), as l for n = 1 (geometric similarity).
//
// eta = -2 ln e sqrt(m k / (pi^2 + ln^2 e)) and Tc = pi / sqrt(k/m - (eta/2m)^2) are the exact
// solution of the damped linear spring up to its first return to zero overlap (Cundall & Strack
// 1979; Schaefer, Dippel, Wolf 1996). Substituting eta gives Tc = sqrt((pi^2 + ln^2 e) m / k).
#include "coupling/shared/coarse_grain_scaling.hpp"

#include <cmath>
#include <numbers>

#include "coupling/shared/error.hpp"

namespace gasgrain {

namespace {

void check(double coarse_grain_ratio, StiffnessExponent n) {
  GASGRAIN_ASSERT(coarse_grain_ratio >= 1.0);
  GASGRAIN_ASSERT(n.value >= 1.0 && n.value <= 3.0);
}

void check_contact(double restitution, double effective_mass, double spring_constant) {
  GASGRAIN_ASSERT(restitution > 0.0 && restitution <= 1.0);
  GASGRAIN_ASSERT(effective_mass > 0.0 && spring_constant > 0.0);
}

}  // namespace

double grain_spring_constant(double original_spring_constant, double coarse_grain_ratio,
                             StiffnessExponent n) {
  check(coarse_grain_ratio, n);
  return std::pow(coarse_grain_ratio, n.value) * original_spring_constant;
}

double grain_damping_coefficient(double original_damping_coefficient, double coarse_grain_ratio,
                                 StiffnessExponent n) {
  check(coarse_grain_ratio, n);
  return std::pow(coarse_grain_ratio, 0.5 * (n.value + 3.0)) * original_damping_coefficient;
}

double damping_coefficient(double restitution, double effective_mass, double spring_constant) {
  check_contact(restitution, effective_mass, spring_constant);
  const double ln_e = std::log(restitution);
  const double pi = std::numbers::pi;
  // 0 - ...: restitution 1 gives +0
  return 0.0 - 2.0 * ln_e * std::sqrt(effective_mass * spring_constant / (pi * pi + ln_e * ln_e));
}

double contact_time(double restitution, double effective_mass, double spring_constant) {
  check_contact(restitution, effective_mass, spring_constant);
  const double ln_e = std::log(restitution);
  const double pi = std::numbers::pi;
  return std::sqrt((pi * pi + ln_e * ln_e) * effective_mass / spring_constant);
}

}  // namespace gasgrain
