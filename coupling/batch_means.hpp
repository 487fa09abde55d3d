// Time mean of a fluctuating quantity with its 95 % confidence interval.
#pragma once

#include <limits>
#include <optional>
#include <vector>

namespace gasgrain::coupling {

struct TimeMean {
  double value = std::numeric_limits<double>::quiet_NaN();  // NaN: no samples
  std::optional<double> half_width;  // of the 95 % interval; empty with too few samples
};

// A value that held over an interval that ended at `time`.
struct TimedSample {
  double time;      // s
  double interval;  // s
  double value;
};

// Mean weighted by the intervals of the samples with time > from; the confidence interval comes
// from the scatter of ten batches of equal duration (Student t, nine degrees of freedom).
TimeMean batch_mean(const std::vector<TimedSample>& samples, double from);

}  // namespace gasgrain::coupling
