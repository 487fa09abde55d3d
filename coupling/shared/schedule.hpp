// When the next output is due, in simulated time.
#pragma once

#include <cmath>

namespace gasgrain {

class Schedule {
 public:
  // Due once per `interval` [s] of simulated time; 0: at every call.
  explicit Schedule(double interval) : interval_(interval) {}

  // True at most once per interval: at the first call at or after its end.
  bool due(double time) {
    if (interval_ <= 0) return true;
    const double intervals =
        std::floor(time / interval_ * (1 + 1e-9));  // rounding of sums of steps
    if (intervals <= done_) return false;
    done_ = intervals;
    return true;
  }

  // As if due() had been called at every moment up to `time`: a run that continues there.
  void skip_to(double time) { due(time); }

 private:
  double interval_;
  double done_ = 0;  // whole intervals passed
};

}  // namespace gasgrain
