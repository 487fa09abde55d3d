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
// Sources: Ergun, Chem. Eng. Prog. 48 (1952) 89; Wen & Yu, Chem. Eng. Prog. Symp. Ser. 62 (1966)
// 100; Schiller & Naumann, Z. VDI 77 (1933) 318; Gidaspow, Multiphase Flow and Fluidization (1994).
#include "coupling/shared/drag.hpp"

#include <array>
#include <cmath>

#include "coupling/shared/error.hpp"

namespace gasgrain {

namespace {

constexpr double dense_limit = 0.8;      // void fraction up to which Ergun holds (Gidaspow)
constexpr double newton_reynolds = 1e3;  // from here on C_D is constant
constexpr double newton_drag = 0.44;

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
  const double reynolds = in.void_fraction * in.density * in.slip * in.diameter / in.viscosity;
  return 18.0 * in.viscosity / (in.diameter * in.diameter) * stokes_multiple(reynolds) *
         std::pow(in.void_fraction, -2.65);
}

struct NamedClosure {
  const char* name;
  DragClosure closure;
};

constexpr std::array<NamedClosure, 1> closures{{{"gidaspow", drag_gidaspow}}};

}  // namespace

double drag_gidaspow(const DragInput& input) {
  GASGRAIN_ASSERT(input.void_fraction > 0.0 && input.void_fraction <= 1.0);
  GASGRAIN_ASSERT(input.slip >= 0.0);
  return input.void_fraction <= dense_limit ? ergun(input) : wen_yu(input);
}

DragClosure find_drag_closure(const std::string& name) {
  for (const NamedClosure& entry : closures) {
    if (name == entry.name) return entry.closure;
  }
  return nullptr;
}

std::vector<std::string> drag_closure_names() {
  std::vector<std::string> names;
  for (const NamedClosure& entry : closures) names.emplace_back(entry.name);
  return names;
}

}  // namespace gasgrain
