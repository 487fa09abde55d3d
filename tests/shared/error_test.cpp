#include "coupling/shared/error.hpp"

#include <gtest/gtest.h>

#include <array>

namespace gasgrain {
namespace {

const std::array<std::string, 3> names{"density", "viscosity", "gravity"};

std::string nearest(const std::string& name) {
  return nearest_name(name, names.data(), names.data() + names.size());
}

TEST(Error, NearestNameForgivesTypingMistakes) {
  EXPECT_EQ(nearest("densty"), "density");
  EXPECT_EQ(nearest("viskosity"), "viscosity");
  EXPECT_EQ(nearest("gravty"), "gravity");
  EXPECT_EQ(nearest("density"), "density");
}

TEST(Error, NearestNameIsEmptyWhenNothingIsNear) {
  EXPECT_EQ(nearest("temperature"), "");
  EXPECT_EQ(nearest_name("x", names.data(), names.data()), "");
}

TEST(Error, AssertionsNameConditionAndPlace) {
  EXPECT_NO_THROW(GASGRAIN_ASSERT(1 + 1 == 2));
  try {
    GASGRAIN_ASSERT(1 + 1 == 3);
    FAIL();
  } catch (const InternalError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("1 + 1 == 3"), std::string::npos);
    EXPECT_NE(text.find("error_test.cpp:"), std::string::npos);
  }
}

}  // namespace
}  // namespace gasgrain
