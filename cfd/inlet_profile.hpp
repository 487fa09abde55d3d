// How the velocity of an inlet is distributed over its side or patch.
#pragma once

#include <array>
#include <vector>

#include "coupling/shared/config_table.hpp"
#include "coupling/shared/vec3.hpp"

namespace gasgrain::cfd {

enum class ProfileKind { uniform, parabolic, table };

struct InletProfile {
  ProfileKind kind = ProfileKind::uniform;
  std::array<bool, 3> along{};  // parabolic: zero on the edges in these directions
  // table: velocities inwards (m/s, >= 0) on a lattice, linear between its points; a direction
  // without coordinates does not matter. The first direction with coordinates runs fastest.
  std::array<std::vector<double>, 3> coordinates;  // m, increasing
  std::vector<double> velocities;
};

// A rectangle of a side of the grid; the component across it is not used.
struct Rectangle {
  Vec3 lower, upper;  // m
};

// Means of the profile over `face`, exact. A parabola spans `extent` and has mean 1 there; a table
// gives m/s and must cover the face.
double mean_over_face(const InletProfile& profile, int across, const Rectangle& extent,
                      const Rectangle& face);

// Throws UserError, which `where` opens, when a table does not cover `extent`.
void check_coverage(const InletProfile& profile, const Rectangle& extent, const std::string& where);

// Reads profile, profile_along and profile_file of an inlet in a side across direction `across`.
// Throws UserError.
InletProfile read_inlet_profile(const ConfigTable& table, int across);

}  // namespace gasgrain::cfd
