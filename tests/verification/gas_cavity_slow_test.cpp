#include <gtest/gtest.h>

#include "tests/verification/lid_driven_cavity.hpp"

namespace gasgrain::verification {
namespace {

TEST(LidDrivenCavity, extremes_agree_with_ghia_at_re_100) {
  report_cavity("cavity_re_100", 100, {32, 64, 128});
}

TEST(LidDrivenCavity, extremes_agree_with_ghia_at_re_400) {
  report_cavity("cavity_re_400", 400, {32, 64, 128});
}

TEST(LidDrivenCavity, extremes_agree_with_ghia_at_re_1000) {
  report_cavity("cavity_re_1000", 1000, {32, 64, 128});
}

}  // namespace
}  // namespace gasgrain::verification
