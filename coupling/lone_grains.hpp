// Grains that are alone feel gas that they have slowed themselves.
#pragma once

#include <optional>
#include <string>

#include "coupling/exchange_report.hpp"

namespace gasgrain::coupling {

// Share of its slip, 0 to 1, that a lone grain of `diameter` [m] loses in slow flow because what it
// gives to the gas by a kernel of standard deviation `width` [m] comes back to it.
double self_slowing(double diameter, double width);

bool most_grains_are_alone(const ExchangeReport& report);

// For the user, when most grains are alone and lose more than 2 % of their slip. `diameter` of the
// largest grain, `width` of the kernel, m; 0: none, for which there is no estimate.
std::optional<std::string> warning_of_lone_grains(const ExchangeReport& report, double diameter,
                                                  double width);

}  // namespace gasgrain::coupling
