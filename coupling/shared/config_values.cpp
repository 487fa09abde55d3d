// What reading of a case file needs no TOML for: ranges, defaults, choices, vectors and paths,
// built on the readings of config_table.cpp.
#include <cmath>
#include <filesystem>
#include <limits>
#include <sstream>

#include "coupling/shared/config_table.hpp"
#include "coupling/shared/error.hpp"

namespace gasgrain {

bool Range::contains(double value) const {
  const bool above = lower_open ? value > lower : value >= lower;
  const bool below = upper_open ? value < upper : value <= upper;
  return above && below && std::isfinite(value);
}

std::string Range::text() const {
  std::ostringstream out;
  out << (lower_open || std::isinf(lower) ? "(" : "[") << lower << ", " << upper
      << (upper_open || std::isinf(upper) ? ")" : "]");
  return out.str();
}

double ConfigTable::number_or(const std::string& key, double otherwise,
                              const Range& allowed) const {
  return has(key) ? number(key, allowed) : otherwise;
}

long ConfigTable::integer_or(const std::string& key, long otherwise, const Range& allowed) const {
  return has(key) ? integer(key, allowed) : otherwise;
}

std::string ConfigTable::text_or(const std::string& key, const std::string& otherwise) const {
  return has(key) ? text(key) : otherwise;
}

std::string ConfigTable::choice(const std::string& key,
                                const std::vector<std::string>& allowed) const {
  std::string list;
  for (const std::string& name : allowed) list += (list.empty() ? "" : ", ") + name;
  if (!has(key)) fail(key, "is missing; give one of: " + list);
  const std::string value = text(key);
  for (const std::string& name : allowed) {
    if (name == value) return value;
  }
  const std::string near = nearest_name(value, allowed.data(), allowed.data() + allowed.size());
  fail(key, "is '" + value + "', but must be one of: " + list +
                (near.empty() ? "" : "; did you mean '" + near + "'?"));
}

std::string ConfigTable::choice_or(const std::string& key, const std::string& otherwise,
                                   const std::vector<std::string>& allowed) const {
  return has(key) ? choice(key, allowed) : otherwise;
}

Vec3 ConfigTable::vector(const std::string& key) const {
  const std::vector<double> values = numbers(key);
  if (values.size() != 3) {
    fail(key, "has " + std::to_string(values.size()) + " components, but must have 3");
  }
  return {values[0], values[1], values[2]};
}

Vec3 ConfigTable::vector_or(const std::string& key, const Vec3& otherwise) const {
  return has(key) ? vector(key) : otherwise;
}

std::array<int, 3> ConfigTable::integers3(const std::string& key, const Range& allowed) const {
  const Vec3 values = vector(key);
  std::array<int, 3> result{};
  for (int d = 0; d < 3; ++d) {
    if (values[d] != std::round(values[d]) || !allowed.contains(values[d]) ||
        std::abs(values[d]) > std::numeric_limits<int>::max()) {
      std::ostringstream message;
      message << "is [" << values[0] << ", " << values[1] << ", " << values[2]
              << "], but must hold three integers in " << allowed.text();
      fail(key, message.str());
    }
    result[d] = static_cast<int>(values[d]);
  }
  return result;
}

void ConfigTable::fail(const std::string& key, const std::string& message) const {
  throw UserError(where(key) + ": " + message);
}

std::string ConfigTable::resolve_path(const std::string& path) const {
  const std::filesystem::path given(path);
  if (given.is_absolute()) return path;
  return (std::filesystem::path(file()).parent_path() / given).string();
}

}  // namespace gasgrain
