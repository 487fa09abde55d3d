// Two kinds of failure: a UserError is bad input and tells its remedy; GASGRAIN_ASSERT is our bug.
#pragma once

#include <stdexcept>
#include <string>

namespace gasgrain {

// Bad input. The message names where (file, line, key), the value, the allowed range and the remedy.
class UserError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// A broken promise inside gasgrain.
class InternalError : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

[[noreturn]] void assertion_failed(const char* condition, const char* file, int line);

// The name in `known` that is closest to `name` by edit distance, or "" when none is near
// (distance above a third of its length, at least 2).
std::string nearest_name(const std::string& name, const std::string* known_begin,
                         const std::string* known_end);

}  // namespace gasgrain

#define GASGRAIN_ASSERT(condition) \
  ((condition) ? void(0) : ::gasgrain::assertion_failed(#condition, __FILE__, __LINE__))
