#include "coupling/shared/drag.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "coupling/shared/error.hpp"

namespace gasgrain {
namespace {

// Air of the reference values: they follow to all printed digits with this density, viscosity,
// g = 9.81 m/s^2 and buoyancy.
constexpr double rho = 1.0, mu = 1.8e-5, g = 9.81;

struct Powder {
  double diameter, density;
  double terminal_velocity;     // m/s
  double minimum_fluidization;  // mm/s at void fraction 0.40
};
constexpr Powder powders[] = {
    {100e-6, 2500, .5686, 9.7}, {180e-6, 1516, .8885, 19.0}, {100e-6, 1483, .3613, 5.7}};

double drag(double void_fraction, double diameter, double slip) {
  return drag_gidaspow({void_fraction, diameter, slip, rho, mu});
}

// Root of an increasing function between 0 and 10.
template <class Function>
double root(const Function& f) {
  double low = 0, high = 10;
  for (int n = 0; n < 100; ++n) {
    const double middle = 0.5 * (low + high);
    (f(middle) < 0 ? low : high) = middle;
  }
  return low;
}

TEST(DragGidaspow, IsErgunInADenseBed) {
  // eps 0.4, d 1 mm, slip 0.5 m/s, by hand: 150 * 0.6 * 1.8e-5 / (0.4 * 1e-6) = 4050 and
  // 1.75 * 1 * 0.5 / 1e-3 = 875
  EXPECT_NEAR(drag(0.4, 1e-3, 0.5), 4925.0, 1e-9);
  EXPECT_NEAR(drag(0.8, 1e-3, 0.0), 150 * 0.2 * 1.8e-5 / (0.8 * 1e-6), 1e-9);
}

TEST(DragGidaspow, IsWenYuInADiluteFlow) {
  // the printed form 3/4 C_D rho |u-v| eps / d0 eps^-2.65 with Re = 0.9 * 0.5 * 1e-4 / 1.8e-5 = 2.5
  const double reynolds = 2.5;
  const double drag_coefficient = 24 / reynolds * (1 + 0.15 * std::pow(reynolds, 0.687));
  EXPECT_NEAR(drag(0.9, 1e-4, 0.5),
              0.75 * drag_coefficient * 0.5 * 0.9 / 1e-4 * std::pow(0.9, -2.65), 1e-6);
}

TEST(DragGidaspow, HasConstantDragCoefficientAtHighReynolds) {
  // Re = 0.9 * 10 * 0.01 / 1.8e-5 = 5000
  EXPECT_NEAR(drag(0.9, 1e-2, 10.0), 0.75 * 0.44 * 10 * 0.9 / 1e-2 * std::pow(0.9, -2.65), 1e-9);
}

TEST(DragGidaspow, ReducesToStokesForASingleSlowSphere) {
  for (const double diameter : {1e-5, 1e-4, 1e-3}) {
    const double stokes = 18 * mu / (diameter * diameter);
    EXPECT_DOUBLE_EQ(drag(1.0, diameter, 0.0), stokes);
    const double slip = 1e-9 * mu / (rho * diameter);
    EXPECT_NEAR(drag(1.0, diameter, slip) / stokes, 1.0, 1e-6);
  }
}

TEST(DragGidaspow, GrowsWithSlipAndSolids) {
  double before = 0;
  for (double slip = 0; slip < 3; slip += 0.01) {
    EXPECT_GE(drag(0.95, 180e-6, slip), before);
    before = drag(0.95, 180e-6, slip);
  }
  for (double eps = 0.82; eps < 0.99; eps += 0.01) {
    EXPECT_GT(drag(eps, 180e-6, 0.1), drag(eps + 0.01, 180e-6, 0.1));
  }
}

TEST(DragGidaspow, GivesTheTerminalVelocities) {
  for (const Powder& p : powders) {
    const double velocity =
        root([&](double v) { return drag(1.0, p.diameter, v) * v - (p.density - rho) * g; });
    EXPECT_NEAR(velocity, p.terminal_velocity, 0.0001) << p.diameter << " " << p.density;
  }
}

TEST(DragGidaspow, GivesTheMinimumFluidizationVelocities) {
  for (const Powder& p : powders) {
    // model A in a bed at rest: eps dp/dx = beta slip, and the bed floats when dp/dx carries
    // (1-eps)(rho_s - rho) g; slip = U / eps
    const double velocity = root([&](double superficial) {
      const double slip = superficial / 0.4;
      return drag(0.4, p.diameter, slip) * slip / 0.4 - (p.density - rho) * g;
    });
    EXPECT_NEAR(1e3 * velocity, p.minimum_fluidization, 0.06);
  }
}

TEST(DragGidaspow, GivesTheFallingVelocityOfAPlug) {
  const auto velocity = [](double diameter, double density, double eps) {
    return g * eps * eps * density / drag(eps, diameter, 0.0);
  };
  EXPECT_NEAR(1e3 * velocity(180e-6, 1516, .4122), 21.3, 0.05);
  EXPECT_NEAR(1e3 * velocity(100e-6, 1483, .4073), 6.1, 0.05);
}

TEST(DragGidaspow, GivesTheFixedBedPressureDrop) {
  // d 1 mm, eps .451335, length .0156 m, rho 10, nu 1.5e-4
  const double eps = .451335;
  for (const auto& [superficial, pressure] :
       {std::pair{.002, 22.99}, std::pair{.01, 115.09}, std::pair{.02, 230.51}}) {
    const double slip = superficial / eps;
    const double beta = (1 - eps) * drag_gidaspow({eps, 1e-3, slip, 10.0, 1.5e-3});
    EXPECT_NEAR(beta * slip / eps * .0156, pressure, 0.005);
  }
}

TEST(DragGidaspow, RefusesAVoidFractionOutOfRange) {
  EXPECT_THROW(drag(0.0, 1e-3, 0.1), InternalError);
  EXPECT_THROW(drag(1.01, 1e-3, 0.1), InternalError);
  EXPECT_THROW(drag(0.5, 1e-3, -0.1), InternalError);
}

// beta/(1-eps) d0^2/mu of a closure at a given Re.
double dimensionless(DragClosure closure, double void_fraction, double reynolds) {
  const double diameter = 1e-3;
  const double slip = reynolds * mu / (void_fraction * rho * diameter);
  return closure({void_fraction, diameter, slip, rho, mu}) * diameter * diameter / mu;
}

TEST(DragClosures, OfASingleSlowSphereAreStokes) {
  for (const DragClosure closure :
       {drag_gidaspow, drag_beetstra, drag_koch_hill, drag_tenneti, drag_schiller_naumann}) {
    EXPECT_DOUBLE_EQ(dimensionless(closure, 1.0, 0.0), 18.0);
    EXPECT_NEAR(dimensionless(closure, 1.0, 1e-8), 18.0, 1e-3);
  }
  // Dallavalle's C_D = 4.8^2/Re instead of 24/Re
  EXPECT_NEAR(dimensionless(drag_difelice, 1.0, 0.0), 0.75 * 4.8 * 4.8, 1e-12);
}

TEST(DragClosures, OfASingleSphereFollowTheStandardDragCurve) {
  // C_D of a sphere: 4.1 at Re 10, 1.09 at Re 100 (Clift, Grace & Weber 1978)
  for (const DragClosure closure :
       {drag_gidaspow, drag_gidaspow_blended, drag_difelice, drag_tenneti, drag_schiller_naumann}) {
    EXPECT_NEAR(dimensionless(closure, 1.0, 10) / (0.75 * 10), 4.1, 0.15 * 4.1);
    EXPECT_NEAR(dimensionless(closure, 1.0, 100) / (0.75 * 100), 1.09, 0.15 * 1.09);
  }
}

TEST(DragClosures, OfASlowDenseBedLieBetweenErgunAndCarman) {
  // constant (1-eps)/eps with 150 (Ergun) to 180 (Carman), and 15 % for a fit over all void
  // fractions
  const double shape = 0.58 / 0.42;
  for (const DragClosure closure :
       {drag_gidaspow, drag_difelice, drag_beetstra, drag_koch_hill, drag_tenneti}) {
    EXPECT_GT(dimensionless(closure, 0.42, 0.0), 0.85 * 150 * shape);
    EXPECT_LT(dimensionless(closure, 0.42, 0.0), 1.15 * 180 * shape);
  }
  EXPECT_NEAR(dimensionless(drag_koch_hill, 0.42, 0.0), 180 * shape, 1e-9);
}

TEST(DragClosures, OfADenseBedAgreeWithErgunAtModerateReynolds) {
  for (const double reynolds : {1.0, 10.0, 100.0}) {
    const double ergun = dimensionless(drag_gidaspow, 0.42, reynolds);
    for (const DragClosure closure : {drag_difelice, drag_beetstra, drag_koch_hill, drag_tenneti}) {
      EXPECT_NEAR(dimensionless(closure, 0.42, reynolds), ergun, 0.3 * ergun) << reynolds;
    }
  }
}

TEST(DragClosures, KochHillJoinsItsBranchesAtFourTenths) {
  const double below = dimensionless(drag_koch_hill, 0.6 + 1e-9, 0.0);
  EXPECT_NEAR(dimensionless(drag_koch_hill, 0.6 - 1e-9, 0.0) / below, 1.0, 0.02);
}

// The formula in print, normalized by 3 pi mu d eps U, at phi = 0.3 and Re = 100:
// F_isol = 1 + 0.15 * 100^0.687 = 4.5489..., the other terms by hand.
TEST(DragClosures, TennetiIsTheFormulaInPrint) {
  const double eps = 0.7, phi = 0.3;
  const double isolated = (1 + 0.15 * std::pow(100, 0.687)) / (eps * eps * eps);
  const double crowded = 5.81 * phi / (eps * eps * eps) + 0.48 * std::cbrt(phi) / std::pow(eps, 4);
  const double inertia = 0.027 * 100 * (0.95 + 0.61 * 0.027 / 0.49);
  EXPECT_NEAR(dimensionless(drag_tenneti, eps, 100),
              18 * eps * eps * (isolated + crowded + inertia), 1e-9);
  EXPECT_NEAR(isolated + crowded + inertia, 22.33, 0.01);
}

// Likewise, at phi = 0.4 and Re = 100: 11.111 + 0.702 + 4.780 * 4.118 / 1.0398.
TEST(DragClosures, BeetstraIsTheFormulaInPrint) {
  const double rest = 10 * 0.4 / 0.36 + 0.36 * (1 + 1.5 * std::sqrt(0.4));
  EXPECT_NEAR(dimensionless(drag_beetstra, 0.6, 0), 18 * 0.6 * rest, 1e-9);
  EXPECT_NEAR(dimensionless(drag_beetstra, 0.6, 100) / (18 * 0.6), 30.74, 0.01);
}

// At phi = 0.2 and Re = 50: F0 = 4.4977 / 0.86228 = 5.2161, F3 = 0.0673 + 0.0424 + 0.0708.
TEST(DragClosures, KochHillIsTheFormulaInPrint) {
  EXPECT_NEAR(dimensionless(drag_koch_hill, 0.8, 0) / (18 * 0.64), 5.2161, 1e-3);
  EXPECT_NEAR(dimensionless(drag_koch_hill, 0.8, 50) / (18 * 0.64), 5.2161 + 25 * 0.1805, 1e-3);
}

// At eps = 0.5 and Re = 100: C_D = 1.11^2, chi = 3.7 - 0.65 exp(-1/8) = 3.1264, and the force per
// volume 3/4 C_D rho |u-v| eps^(2 - chi)/d0.
TEST(DragClosures, DiFeliceIsTheFormulaInPrint) {
  EXPECT_NEAR(dimensionless(drag_difelice, 0.5, 100),
              0.75 * 1.11 * 1.11 * 100 * std::pow(0.5, 1 - 3.1264), 0.05);
}

TEST(DragClosures, BlendedGidaspowJoinsErgunAndWenYu) {
  const double below = dimensionless(drag_gidaspow, 0.8, 10);
  const double above = dimensionless(drag_gidaspow, 0.8 + 1e-12, 10);
  EXPECT_GT(std::abs(below - above), 0.05 * above);
  EXPECT_NEAR(dimensionless(drag_gidaspow_blended, 0.8, 10), 0.5 * (below + above), 1e-6);
  EXPECT_NEAR(dimensionless(drag_gidaspow_blended, 0.4, 10), dimensionless(drag_gidaspow, 0.4, 10),
              0.005 * dimensionless(drag_gidaspow, 0.4, 10));
  for (double eps = 0.7; eps < 0.9; eps += 0.001) {
    EXPECT_NEAR(dimensionless(drag_gidaspow_blended, eps, 10),
                dimensionless(drag_gidaspow_blended, eps + 1e-4, 10), 0.03 * above);
  }
}

// beta/(1-eps) of a mixture of two sizes.
TEST(DragInMixture, HasTheRightLimits) {
  const double small = 1e-4, large = 3e-4, mean = 2e-4;
  const auto drag_of = [&](double diameter, double eps) {
    return drag_in_mixture(drag_gidaspow, {eps, diameter, 0.0, rho, mu}, mean);
  };
  // alone: Stokes of its own diameter
  EXPECT_NEAR(drag_of(small, 1.0), 18 * mu / (small * small), 1e-9);
  EXPECT_NEAR(drag_of(large, 1.0), 18 * mu / (large * large), 1e-9);
  // equal grains: the closure
  EXPECT_DOUBLE_EQ(drag_of(mean, 0.45), drag_gidaspow({0.45, mean, 0.0, rho, mu}));
}

TEST(DragInMixture, OfADenseBedAddsUpToNearlyThatOfTheMeanGrain) {
  // half the volume each of two sizes: 1/d_m = (1/d_1 + 1/d_2)/2; the dense part is exactly that
  // of the mean grain, the dilute part larger by eps times the variance of 1/y
  const double d1 = 1e-4, d2 = 2e-4, mean = 2.0 / (1.0 / d1 + 1.0 / d2), eps = 0.4;
  double sum = 0.0, square = 0.0;
  for (const double d : {d1, d2}) {
    sum += 0.5 * drag_in_mixture(drag_gidaspow, {eps, d, 0.1, rho, mu}, mean);
    square += 0.5 * mean * mean / (d * d);
  }
  const double alike = drag_gidaspow({eps, mean, 0.1, rho, mu});
  EXPECT_NEAR(sum / alike, (1 - eps) + eps * square, 1e-12);
  EXPECT_LT(sum / alike, 1.05);
}

TEST(DragClosures, AreFoundByTheirNames) {
  EXPECT_EQ(find_drag_closure("koch-hill"), &drag_koch_hill);
  EXPECT_EQ(find_drag_closure("gidaspow"), &drag_gidaspow);
  EXPECT_EQ(find_drag_closure("gidaspov"), nullptr);
  for (const std::string& name : drag_closure_names()) {
    EXPECT_NE(find_drag_closure(name), nullptr) << name;
  }
}

}  // namespace
}  // namespace gasgrain
