#include "coupling/shared/schedule.hpp"

#include <gtest/gtest.h>

namespace gasgrain {
namespace {

TEST(Schedule, is_due_once_per_interval_in_spite_of_rounding) {
  Schedule schedule(0.01);
  int due = 0;
  double time = 0;
  for (int step = 1; step <= 1000; ++step) {
    time += 1e-4;  // 1e-4 * 100 sums to a little below or above 0.01
    due += schedule.due(time);
  }
  EXPECT_EQ(due, 10);
}

TEST(Schedule, does_not_catch_up_on_intervals_that_passed_unseen) {
  Schedule schedule(0.01);
  EXPECT_TRUE(schedule.due(0.055));
  EXPECT_FALSE(schedule.due(0.056));
  EXPECT_TRUE(schedule.due(0.06));
}

TEST(Schedule, of_a_restarted_run_is_that_of_the_uninterrupted_one) {
  Schedule whole(0.01), continued(0.01);
  double time = 0;
  for (int step = 1; step <= 1000; ++step) {
    time += 1e-4;
    const bool due = whole.due(time);
    if (step == 500) continued.skip_to(time);  // where rounding decides
    if (step > 500) {
      EXPECT_EQ(continued.due(time), due) << step;
    }
  }
}

TEST(Schedule, of_interval_zero_is_always_due) {
  Schedule schedule(0.0);
  EXPECT_TRUE(schedule.due(0.0));
  EXPECT_TRUE(schedule.due(0.0));
}

}  // namespace
}  // namespace gasgrain
