#include "coupling/run_report.hpp"

#include <gtest/gtest.h>

namespace gasgrain::coupling {
namespace {

SeriesRow row_at(double time) {
  SeriesRow row;
  row.time = time;
  return row;
}

TEST(ProgressText, what_is_left_follows_the_pace_of_the_part_under_way) {
  // 100 of 300 steps took 10 s in this part of the run, 500 are left
  const std::string line =
      progress_text(row_at(0.1), {}, {.done = 300, .total = 800}, {.steps = 100, .seconds = 10.0});
  EXPECT_NE(line.find(" 38 %  50 s left"), std::string::npos) << line;
}

TEST(ProgressText, nothing_is_known_of_the_rest_before_the_first_step) {
  const std::string line =
      progress_text(row_at(0.0), {}, {.done = 300, .total = 800}, {.steps = 0, .seconds = 0.1});
  EXPECT_NE(line.find("? left"), std::string::npos) << line;
}

}  // namespace
}  // namespace gasgrain::coupling
