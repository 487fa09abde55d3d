// Boundary condition of one side of the grid.
#pragma once

#include <array>
#include <string>

#include "coupling/shared/config_table.hpp"
#include "coupling/shared/vec3.hpp"

namespace gasgrain::cfd {

enum class BoundaryType { no_slip, slip, inlet, outlet, periodic };

struct Boundary {
  BoundaryType type = BoundaryType::no_slip;
  Vec3 superficial_velocity = Vec3::Zero();  // m/s, inlet: the flux eps u that enters (void
                                             // fraction times velocity)
  Vec3 wall_velocity = Vec3::Zero();         // m/s, no_slip: velocity of the wall in its plane
  double pressure = 0.0;                     // Pa, outlet
};

// [direction][side], side 0 = lower, 1 = upper.
using Boundaries = std::array<std::array<Boundary, 2>, 3>;

// Reads [boundary] with keys x_lower ... z_upper. Throws UserError.
Boundaries read_boundaries(const ConfigTable& boundary_table);

// Directions whose two sides are joined.
std::array<bool, 3> periodic_directions(const Boundaries& boundaries);

}  // namespace gasgrain::cfd
