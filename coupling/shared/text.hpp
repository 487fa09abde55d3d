// Text for people: numbers in sentences and durations.
#pragma once

#include <string>

#include "coupling/shared/vec3.hpp"

namespace gasgrain {

// As printf.
[[gnu::format(printf, 1, 2)]] std::string text(const char* format, ...);

// "(1, 2.5, 3)", six digits each.
std::string text(const Vec3& x);

// "42 s", "3 min 05 s" or "2 h 10 min"; "?" when it is not finite.
std::string duration(double seconds);

}  // namespace gasgrain
