// Drag closures as beta / (1 - eps): momentum exchange per solid volume and slip (eq 13-15).
//
//   Ergun     beta/(1-eps) = 150 (1-eps) mu / (eps d0^2) + 1.75 rho |u-v| / d0         eps <= 0.8
//   Wen-Yu    beta/(1-eps) = 3/4 C_D rho |u-v| eps / d0 eps^-2.65                      eps > 0.8
//   C_D = 24/Re (1 + 0.15 Re^0.687),  0.44 from Re = 1000 on,  Re = eps rho |u-v| d0 / mu
//
// The Wen-Yu branch is evaluated as 18 mu/d0^2 (1 + 0.15 Re^0.687) eps^-2.65, the same with C_D Re
// written out, so that it is finite at rest. The paper's eq 14 lacks rho in that branch (misprint).
// The two branches do not join at eps = 0.8, nor does C_D at Re = 1000: that is the published law.
//
// The other closures are written in the same form: beta/(1-eps) = 18 mu/d0^2 times a function of
// eps and Re, model A (the pressure gradient acts on the grains separately).
//
// Sources: Ergun, Chem. Eng. Prog. 48 (1952) 89; Wen & Yu, Chem. Eng. Prog. Symp. Ser. 62 (1966)
// 100; Schiller & Naumann, Z. VDI 77 (1933) 318; Gidaspow, Multiphase Flow and Fluidization (1994).
#include "coupling/shared/drag.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include "coupling/shared/error.hpp"

namespace gasgrain {

namespace {

constexpr double dense_limit = 0.8;      // void fraction up to which Ergun holds (Gidaspow)
constexpr double newton_reynolds = 1e3;  // from here on C_D is constant
constexpr double newton_drag = 0.44;

void check(const DragInput& in) {
  GASGRAIN_ASSERT(in.void_fraction > 0.0 && in.void_fraction <= 1.0);
  GASGRAIN_ASSERT(in.slip >= 0.0);
}

// 18 mu / d0^2: beta/(1-eps) of a single sphere at rest.
double stokes(const DragInput& in) {
  return 18.0 * in.viscosity / (in.diameter * in.diameter);
}

double reynolds_number(const DragInput& in) {
  return in.void_fraction * in.density * in.slip * in.diameter / in.viscosity;
}

// C_D Re / 24 of a single sphere.
double stokes_multiple(double reynolds) {
  if (reynolds >= newton_reynolds) return newton_drag * reynolds / 24.0;
  return 1.0 + 0.15 * std::pow(reynolds, 0.687);
}

double ergun(const DragInput& in) {
  return 150.0 * (1.0 - in.void_fraction) * in.viscosity /
             (in.void_fraction * in.diameter * in.diameter) +
         1.75 * in.density * in.slip / in.diameter;
}

double wen_yu(const DragInput& in) {
  return stokes(in) * stokes_multiple(reynolds_number(in)) * std::pow(in.void_fraction, -2.65);
}

struct NamedClosure {
  const char* name;
  DragClosure closure;
};

constexpr std::array<NamedClosure, 7> closures{{{"gidaspow", drag_gidaspow},
                                                {"gidaspow-blended", drag_gidaspow_blended},
                                                {"difelice", drag_difelice},
                                                {"beetstra", drag_beetstra},
                                                {"koch-hill", drag_koch_hill},
                                                {"tenneti", drag_tenneti},
                                                {"schiller-naumann", drag_schiller_naumann}}};

}  // namespace

double drag_gidaspow(const DragInput& input) {
  check(input);
  return input.void_fraction <= dense_limit ? ergun(input) : wen_yu(input);
}

// psi Wen-Yu + (1 - psi) Ergun, psi = 1/2 + atan(262.5 (eps - 0.8)) / pi. Huilin & Gidaspow, Chem.
// Eng. Sci. 58 (2003) 3777.
double drag_gidaspow_blended(const DragInput& input) {
  check(input);
  constexpr double steepness = 150.0 * 1.75;
  const double share =
      0.5 + std::atan(steepness * (input.void_fraction - dense_limit)) / std::numbers::pi;
  return share * wen_yu(input) + (1.0 - share) * ergun(input);
}

// C_D = (0.63 + 4.8/sqrt(Re))^2 (Dallavalle), force per volume 3/4 C_D rho |u-v| eps^(2-chi) / d0,
// chi = 3.7 - 0.65 exp(-(1.5 - lg Re)^2 / 2). Di Felice, Int. J. Multiphase Flow 20 (1994) 153; as
// model A: Zhou et al., J. Fluid Mech. 661 (2010) 482. C_D Re is written out: finite at rest.
double drag_difelice(const DragInput& input) {
  check(input);
  const double eps = input.void_fraction, reynolds = reynolds_number(input);
  const double root = 0.63 * std::sqrt(reynolds) + 4.8;
  const double decades = 1.5 - std::log10(reynolds);  // infinite at rest: chi = 3.7
  const double chi = 3.7 - 0.65 * std::exp(-0.5 * decades * decades);
  return stokes(input) * root * root / 24.0 * std::pow(eps, 1.0 - chi);
}

// F = 10 phi/eps^2 + eps^2 (1 + 1.5 sqrt(phi))
//   + 0.413 Re/(24 eps^2) (1/eps + 3 phi eps + 8.4 Re^-0.343) / (1 + 10^(3 phi) Re^(-(1+4 phi)/2)),
// phi = 1 - eps, force 3 pi mu d0 eps (u-v) F. Beetstra et al., AIChE J. 53 (2007) 489.
double drag_beetstra(const DragInput& input) {
  check(input);
  const double eps = input.void_fraction, phi = 1.0 - eps, reynolds = reynolds_number(input);
  double f = 10.0 * phi / (eps * eps) + eps * eps * (1.0 + 1.5 * std::sqrt(phi));
  if (reynolds > 0.0) {
    f += 0.413 * reynolds / (24.0 * eps * eps) *
         (1.0 / eps + 3.0 * phi * eps + 8.4 * std::pow(reynolds, -0.343)) /
         (1.0 + std::pow(10.0, 3.0 * phi) * std::pow(reynolds, -0.5 - 2.0 * phi));
  }
  return stokes(input) * eps * f;
}

// beta/(1-eps) = 18 mu eps^2/d0^2 (F0 + F3 Re/2). Hill, Koch & Ladd, J. Fluid Mech. 448 (2001) 213
// and 243; Link et al., Chem. Eng. Sci. 60 (2005) 3425.
double drag_koch_hill(const DragInput& input) {
  check(input);
  const double eps = input.void_fraction, phi = 1.0 - eps;
  double f0 = 10.0 * phi / (eps * eps * eps);
  if (phi <= 0.4) {
    const double phi_ln_phi = phi > 0.0 ? phi * std::log(phi) : 0.0;
    f0 = (1.0 + 3.0 * std::sqrt(0.5 * phi) + 135.0 / 64.0 * phi_ln_phi + 16.14 * phi) /
         (1.0 + phi * (0.681 + phi * (-8.48 + 8.16 * phi)));
  }
  const double f3 = 0.0673 + 0.212 * phi + 0.0232 / std::pow(eps, 5);
  return stokes(input) * eps * eps * (f0 + 0.5 * f3 * reynolds_number(input));
}

// beta/(1-eps) = 18 mu eps^2/d0^2 F,  phi = 1 - eps,
// F = (1 + 0.15 Re^0.687)/eps^3 + 5.81 phi/eps^3 + 0.48 phi^(1/3)/eps^4
//   + phi^3 Re (0.95 + 0.61 phi^3/eps^2).
// Tenneti, Garg & Subramaniam, Int. J. Multiphase Flow 37 (2011) 1072.
double drag_tenneti(const DragInput& input) {
  check(input);
  const double eps = input.void_fraction, phi = 1.0 - eps, reynolds = reynolds_number(input);
  const double cube = phi * phi * phi;
  const double f = (stokes_multiple(reynolds) + 5.81 * phi) / (eps * eps * eps) +
                   0.48 * std::cbrt(phi) / std::pow(eps, 4) +
                   cube * reynolds * (0.95 + 0.61 * cube / (eps * eps));
  return stokes(input) * eps * eps * f;
}

double drag_schiller_naumann(const DragInput& input) {
  check(input);
  return stokes(input) * stokes_multiple(reynolds_number(input));
}

// van der Hoef, Beetstra & Kuipers, J. Fluid Mech. 528 (2005) 233, and Beetstra et al. above.
double drag_in_mixture(DragClosure closure, const DragInput& input, double sauter_diameter) {
  GASGRAIN_ASSERT(sauter_diameter > 0.0);
  const double y = input.diameter / sauter_diameter, eps = input.void_fraction;
  DragInput mean = input;
  mean.diameter = sauter_diameter;
  // forces as eps y + phi y^2, volumes as y^3
  return closure(mean) * (eps / y + 1.0 - eps) / y;
}

DragClosure find_drag_closure(const std::string& name) {
  for (const NamedClosure& entry : closures) {
    if (name == entry.name) return entry.closure;
  }
  return nullptr;
}

std::vector<std::string> drag_closure_names() {
  std::vector<std::string> names;
  names.reserve(closures.size());
  for (const NamedClosure& entry : closures) names.emplace_back(entry.name);
  return names;
}

}  // namespace gasgrain
