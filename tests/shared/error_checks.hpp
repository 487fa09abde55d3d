// The text of the UserError that an action throws, for tests that check what a user reads.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "coupling/shared/error.hpp"

namespace gasgrain {

template <class Action>
std::string user_error(const Action& action) {
  try {
    action();
  } catch (const UserError& error) {
    return error.what();
  }
  return "no error";
}

inline void expect_contains(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << "'" << text << "' lacks '" << part << "'";
}

}  // namespace gasgrain
