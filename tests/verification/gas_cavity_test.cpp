// The lid-driven cavity on a small grid; the others: gas_cavity_slow_test.cpp.
#include <gtest/gtest.h>

#include "tests/verification/lid_driven_cavity.hpp"

namespace gasgrain::verification {
namespace {

TEST(LidDrivenCavity, extremes_agree_with_ghia_at_re_100_on_a_small_grid) {
  report_cavity("cavity_re_100_small", 100, {32, 64});
}

}  // namespace
}  // namespace gasgrain::verification
