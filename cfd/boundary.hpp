// Boundary conditions of the sides of the grid and of patches in them, as the case file states
// them. What holds on each face at a time: cfd/side_conditions.hpp.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "cfd/inlet_profile.hpp"
#include "cfd/time_table.hpp"
#include "coupling/shared/body.hpp"
#include "coupling/shared/config_table.hpp"
#include "coupling/shared/vec3.hpp"

namespace gasgrain::cfd {

enum class BoundaryType { no_slip, slip, inlet, outlet, periodic };

// What gas that enters through an outlet brings: nothing but the pressure of still surroundings, or
// the velocity it has on the face.
enum class Backflow { still, moving };

struct Boundary {
  BoundaryType type = BoundaryType::no_slip;
  Vec3 superficial_velocity = Vec3::Zero();  // m/s, inlet: the flux eps u that enters (void
                                             // fraction times velocity), mean over the faces
  Vec3 wall_velocity = Vec3::Zero();         // m/s, no_slip: velocity of the wall in its plane
  double pressure = 0.0;                     // Pa, outlet
  Backflow backflow = Backflow::still;       // outlet
  double pressure_gradient = 0.0;            // Pa/m, periodic: mean along the direction, lower side
  std::optional<double> mean_velocity;       // m/s, periodic: superficial, keeps the gradient right
  InletProfile profile;                      // inlet
  bool velocity_is_of_profile = false;       // the mean is that of the profile's table
  TimeTable factor;                          // of the velocities and of the pressure
};

// [direction][side], side 0 = lower, 1 = upper.
using Boundaries = std::array<std::array<Boundary, 2>, 3>;

// Faces of a side of the grid with a condition of their own: those whose centre is in `region`.
struct BoundaryPatch {
  std::string name;
  int direction = 0, side = 0;
  Shape region;
  Boundary condition;
};

inline constexpr const char* names_of_sides[3][2] = {
    {"x_lower", "x_upper"}, {"y_lower", "y_upper"}, {"z_lower", "z_upper"}};

// Reads [boundary] with keys x_lower ... z_upper; patches are left to read_patches. Throws
// UserError.
Boundaries read_boundaries(const ConfigTable& boundary_table);

// Reads [[boundary.patch]]; a region is a shape as in [[body]] or the name of one of `bodies`.
// Throws UserError.
std::vector<BoundaryPatch> read_patches(const ConfigTable& boundary_table,
                                        const Boundaries& boundaries,
                                        const std::vector<Body>& bodies, ShapeFileLoader load_file);

// Throws UserError when a time table ends before `end_time` [s].
void check_time_tables(const ConfigTable& boundary_table, const Boundaries& boundaries,
                       const std::vector<BoundaryPatch>& patches, double end_time);

// Directions whose two sides are joined.
std::array<bool, 3> periodic_directions(const Boundaries& boundaries);

}  // namespace gasgrain::cfd
