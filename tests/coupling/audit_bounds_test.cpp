#include "coupling/audit_bounds.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "coupling/shared/error.hpp"

namespace gasgrain::coupling {
namespace {

AuditBounds read(const std::string& text) {
  return read_audit_bounds(ConfigTable::parse(text, "case.toml"));
}

TEST(AuditBounds, nothing_to_say_within_them) {
  EXPECT_TRUE(violations({}, {1e-7, 1e-13, 1e-7, 1e-13, 1e-6, 0.0}, {}).empty());
}

TEST(AuditBounds, say_value_bound_and_cause) {
  const AuditBounds bounds = read("momentum = 1e-3\n");
  const auto found = violations(bounds, {-2e-3, 0, 0, 0, 0, 0}, {.unmeasured_walls = {"floor"}});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].name, "momentum");
  EXPECT_NE(found[0].text.find("-0.002 exceeds coupling.audit.momentum = 0.001"),
            std::string::npos);
  EXPECT_NE(found[0].text.find("wall fix floor"), std::string::npos);
  const auto gone =
      violations(bounds, {1, 0, 0, 0, 0, 0}, {.unmeasured_walls = {}, .unexplained_grains = -3});
  EXPECT_NE(gone[0].text.find("-3 grains appeared or left"), std::string::npos);
}

TEST(AuditBounds, what_is_no_number_is_beyond_every_bound) {
  const double nan = std::nan("");
  EXPECT_EQ(violations({}, {nan, nan, nan, nan, nan, nan}, {}).size(), bound_names.size());
}

TEST(AuditBounds, keys_are_checked) {
  EXPECT_EQ(read("on_violation = \"stop\"\n").on_violation, OnViolation::stop);
  EXPECT_THROW(read("on_violation = \"ignore\"\n"), UserError);
  EXPECT_THROW(read("momentum = 0\n"), UserError);
  EXPECT_THROW(read("mass = 1\n"), UserError);
}

}  // namespace
}  // namespace gasgrain::coupling
