// Case files for tests: the sections that every gas has.
#pragma once

#include <array>
#include <sstream>
#include <string>

#include "cfd/gas_case.hpp"
#include "coupling/shared/vec3.hpp"

namespace gasgrain {

inline std::string toml(const Vec3& v) {
  std::ostringstream text;
  text.precision(17);
  text << "[" << v[0] << ", " << v[1] << ", " << v[2] << "]";
  return text.str();
}

inline std::string inlet(double superficial_velocity) {  // m/s
  std::ostringstream text;
  text.precision(17);
  text << "type = \"inlet\", superficial_velocity = " << superficial_velocity;
  return text.str();
}

// Sections grid, gas and boundary.
struct GasCaseText {
  using Ends = std::array<std::string, 2>;  // lower, upper: a type, or all keys of the side

  Vec3 lower = Vec3::Zero();  // m
  Vec3 upper;
  cfd::Index3 cells;
  cfd::GasProperties gas = {};
  Ends x = {"slip", "slip"}, y = x, z = {"no-slip", "no-slip"};

  std::string text() const {
    std::ostringstream text;
    text.precision(17);
    text << "[grid]\nlower = " << toml(lower) << "\nupper = " << toml(upper) << "\ncells = ["
         << cells[0] << ", " << cells[1] << ", " << cells[2]
         << "]\n[gas]\ndensity = " << gas.density << "\nviscosity = " << gas.viscosity
         << "\ngravity = " << toml(gas.gravity) << "\n[boundary]\n";
    for (int d = 0; d < 3; ++d) {
      const Ends& ends = d == 0 ? x : d == 1 ? y : z;
      for (int side = 0; side < 2; ++side) {
        const bool is_type = ends[side].find('=') == std::string::npos;
        text << "xyz"[d] << (side == 0 ? "_lower = {" : "_upper = {")
             << (is_type ? "type = \"" + ends[side] + "\"" : ends[side]) << "}\n";
      }
    }
    return text.str();
  }
};

}  // namespace gasgrain
