// Stokes flow of a force F spread by a Gaussian of standard deviation s and gathered by the same:
// the mean of F/(6 pi mu r) over directions, with <1/r> = 1/(sqrt(pi) s) for the two kernels
// together. With F = 3 pi mu d U the gas around the grain moves with it by
//
//   u/U = d/(2 sqrt(pi) s),
//
// 24 % at s = 1.2 d. Inertia makes it less, neighbours make it part of the flow that closures mean.
// In a bed it is nothing: there the drag of all neighbours sets the mean slip.
#include "coupling/lone_grains.hpp"

#include <cmath>

#include "coupling/shared/text.hpp"

namespace gasgrain::coupling {

namespace {

constexpr double most = 0.5;         // of the grains
constexpr double acceptable = 0.02;  // of the slip

}  // namespace

double self_slowing(double diameter, double width) {
  return diameter / (2.0 * std::sqrt(M_PI) * width);
}

bool most_grains_are_alone(const ExchangeReport& report) {
  return double(report.grains_alone) > most * double(report.grains_inside);
}

std::optional<std::string> warning_of_lone_grains(const ExchangeReport& report, double diameter,
                                                  double width) {
  if (!most_grains_are_alone(report) || width <= 0.0) return std::nullopt;
  const double share = self_slowing(diameter, width);
  if (share <= acceptable) return std::nullopt;
  return text(
      "%ld of %ld grains are alone (void fraction around them above 0.99): each feels gas that it "
      "has slowed itself, in slow flow by up to %.0f %% of its slip with the kernel of %.3g m; for "
      "%.0f %% set coupling.kernel_width = %.2g or more",
      report.grains_alone, report.grains_inside, 100 * share, width, 100 * acceptable,
      width * share / acceptable);
}

}  // namespace gasgrain::coupling
