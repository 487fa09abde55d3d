#include "coupling/coupling_interval.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace gasgrain::coupling {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

TEST(CouplingInterval, takes_the_least_limit) {
  EXPECT_EQ(choose_interval({1e-4, 1.0, infinity, 1.0}, 1e-6, 0.0).dem_steps, 100);
  EXPECT_EQ(choose_interval({1e-4, 1e-3, infinity, 1.0}, 1e-6, 0.0).dem_steps,
            50);  // 5 % of 1e-3 s
  EXPECT_EQ(choose_interval({1e-4, 1e-3, infinity, 2e-5}, 1e-6, 0.0).dem_steps, 20);
}

TEST(CouplingInterval, follows_walls_that_move) {
  const CouplingInterval found = choose_interval({1e-4, 1.0, 3e-5, 1.0}, 1e-6, 0.0);
  EXPECT_EQ(found.dem_steps, 30);
  EXPECT_EQ(found.limited_by, "wall motion");
}

TEST(CouplingInterval, names_the_limit) {
  EXPECT_EQ(choose_interval({1e-4, 1.0, infinity, 1.0}, 1e-6, 0.0).limited_by, "grain motion");
  EXPECT_EQ(choose_interval({1.0, 1.0, infinity, 1.0}, 1e-6, 1e-4).limited_by, "exchange_interval");
}

TEST(CouplingInterval, is_a_whole_number_of_steps_below_the_limit) {
  EXPECT_EQ(choose_interval({infinity, infinity, infinity, 9.9e-6}, 2e-6, 0.0).dem_steps, 4);
}

TEST(CouplingInterval, is_at_least_one_step) {
  EXPECT_EQ(choose_interval({1e-8, 1.0, infinity, 1.0}, 1e-6, 0.0).dem_steps, 1);
}

TEST(CouplingInterval, request_overrules_all_but_stability) {
  EXPECT_EQ(choose_interval({1e-6, 1e-3, infinity, 1e-6}, 1e-6, 1e-4).dem_steps, 100);
  EXPECT_EQ(choose_interval({1e-6, 1e-4, infinity, 1e-6}, 1e-6, 1e-4).dem_steps, 50);
}

}  // namespace
}  // namespace gasgrain::coupling
