// Sakai's scaling of an original particle to a grain of ratio l >= 1 (eq 3-9 and the exponent n).
#pragma once

namespace gasgrain {

// How stiffness grows with l: k -> l^n k, eta -> l^((n+3)/2) eta. n = 3 is Sakai's law (contact
// time and overlap do not depend on l), n = 1 geometric similarity (overlap / radius is kept).
struct StiffnessExponent {
  double value = 3.0;  // in [1, 3]
};

double grain_spring_constant(double original_spring_constant, double coarse_grain_ratio,
                             StiffnessExponent n);  // N/m
double grain_damping_coefficient(double original_damping_coefficient, double coarse_grain_ratio,
                                 StiffnessExponent n);  // kg/s

// eta = -2 ln e sqrt(m_eff k / (pi^2 + ln^2 e)), kg/s; restitution in (0, 1], effective_mass > 0 in
// kg (m0/2 for equal particles, m0 against a wall), spring_constant > 0 in N/m. All are asserted.
double damping_coefficient(double restitution, double effective_mass, double spring_constant);

// Duration of a contact of the damped spring: pi / sqrt(k/m_eff - (eta/(2 m_eff))^2), s.
double contact_time(double restitution, double effective_mass, double spring_constant);

}  // namespace gasgrain
