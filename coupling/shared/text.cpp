#include "coupling/shared/text.hpp"

#include <cmath>
#include <cstdarg>
#include <cstdio>

namespace gasgrain {

std::string text(const char* format, ...) {
  va_list arguments, again;
  va_start(arguments, format);
  va_copy(again, arguments);
  std::string result(std::vsnprintf(nullptr, 0, format, arguments), '\0');
  std::vsnprintf(result.data(), result.size() + 1, format, again);
  va_end(again);
  va_end(arguments);
  return result;
}

std::string text(const Vec3& x) {
  return text("(%.6g, %.6g, %.6g)", x[0], x[1], x[2]);
}

std::string duration(double seconds) {
  if (!std::isfinite(seconds)) return "?";
  const long s = std::lround(seconds);
  if (s < 60) return text("%ld s", s);
  if (s < 3600) return text("%ld min %02ld s", s / 60, s % 60);
  return text("%ld h %02ld min", s / 3600, s / 60 % 60);
}

}  // namespace gasgrain
