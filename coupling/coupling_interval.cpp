#include "coupling/coupling_interval.hpp"

#include <algorithm>
#include <cmath>

#include "coupling/shared/error.hpp"

namespace gasgrain::coupling {

namespace {

constexpr double accurate_share = 0.05;  // of the exchange limit, by default
constexpr double stable_share = 0.5;     // of the exchange limit, when the user asks for more
constexpr double most_steps = 1e6;       // nothing limits a bed without grains

struct Candidate {
  double interval;
  const char* name;
};

CouplingInterval shortest(std::initializer_list<Candidate> candidates, double dem_step) {
  const Candidate& least =
      *std::min_element(candidates.begin(), candidates.end(),
                        [](const auto& a, const auto& b) { return a.interval < b.interval; });
  // A tiny relative allowance keeps 1e-4 / 1e-6 at 100 steps in spite of rounding.
  const double steps = std::floor(std::min(least.interval / dem_step * (1 + 1e-9), most_steps));
  if (steps < 1) return {1, std::string(least.name) + " (less than one DEM step)"};
  return {static_cast<int>(steps), least.name};
}

}  // namespace

CouplingInterval choose_interval(const IntervalLimits& limits, double dem_step, double requested) {
  GASGRAIN_ASSERT(dem_step > 0);
  if (requested > 0) {
    return shortest({{requested, "exchange_interval"}, {stable_share * limits.exchange, "drag"}},
                    dem_step);
  }
  return shortest({{limits.grain_motion, "grain motion"},
                   {limits.wall_motion, "wall motion"},
                   {accurate_share * limits.exchange, "drag"},
                   {limits.gas, "gas stability"}},
                  dem_step);
}

}  // namespace gasgrain::coupling
