// Batch means: the window is cut into ten batches of equal duration; if a batch is longer than the
// time over which the signal remembers itself, batch means are independent and nearly normal, and
//   half width = t_(0.975, 9) s / sqrt(10),   s^2 = sum (batch - mean)^2 / 9.
// Few batches keep each long. Source: Law & Kelton, Simulation Modeling and Analysis, ch. 9.
#include "coupling/batch_means.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace gasgrain::coupling {

namespace {

constexpr int batches = 10;
constexpr double student_t = 2.262;  // 97.5 % quantile for nine degrees of freedom

}  // namespace

TimeMean batch_mean(const std::vector<TimedSample>& samples, double from) {
  const auto begin = std::find_if(samples.begin(), samples.end(),
                                  [&](const TimedSample& sample) { return sample.time > from; });
  double duration = 0, integral = 0;
  for (auto sample = begin; sample != samples.end(); ++sample) {
    duration += sample->interval;
    integral += sample->interval * sample->value;
  }
  TimeMean mean;
  if (duration <= 0) return mean;
  mean.value = integral / duration;

  std::array<double, batches> weights{}, sums{};
  double elapsed = 0;
  for (auto sample = begin; sample != samples.end(); ++sample) {
    const double middle = (elapsed + 0.5 * sample->interval) / duration;
    const int batch = std::min(batches - 1, static_cast<int>(batches * middle));
    weights[batch] += sample->interval;
    sums[batch] += sample->interval * sample->value;
    elapsed += sample->interval;
  }
  double scatter = 0;
  for (int b = 0; b < batches; ++b) {
    if (weights[b] <= 0) return mean;
    scatter += std::pow(sums[b] / weights[b] - mean.value, 2);
  }
  mean.half_width = student_t * std::sqrt(scatter / (batches - 1) / batches);
  return mean;
}

}  // namespace gasgrain::coupling
