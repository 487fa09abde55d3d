#include "cfd/boundary.hpp"

#include "coupling/shared/error.hpp"

namespace gasgrain::cfd {

namespace {

BoundaryType type_of(const std::string& name) {
  if (name == "no-slip") return BoundaryType::no_slip;
  if (name == "slip") return BoundaryType::slip;
  if (name == "inlet") return BoundaryType::inlet;
  if (name == "outlet") return BoundaryType::outlet;
  return BoundaryType::periodic;
}

// A number is the speed along the inward normal, three numbers are the vector.
Vec3 read_superficial_velocity(const ConfigTable& table, int direction, int side) {
  const std::string key = "superficial_velocity";
  const double inward = side == 0 ? 1.0 : -1.0;
  if (!table.is_list(key)) {
    return inward * table.number(key, Range::non_negative()) * Vec3::Unit(direction);
  }
  Vec3 velocity = table.vector(key);
  if (inward * velocity[direction] < 0.0) {
    table.fail(key, "points out of the grid; an inlet blows inwards, use an outlet for the rest");
  }
  return velocity;
}

void reject_keys_of_other_types(const ConfigTable& table, BoundaryType type) {
  if (type != BoundaryType::inlet && table.has("superficial_velocity")) {
    table.fail("superficial_velocity", "belongs to an inlet; remove it or set type = \"inlet\"");
  }
  if (type != BoundaryType::outlet && table.has("pressure")) {
    table.fail("pressure", "belongs to an outlet; remove it or set type = \"outlet\"");
  }
  if (type != BoundaryType::no_slip && table.has("wall_velocity")) {
    table.fail("wall_velocity", "belongs to a no-slip side; remove it or set type = \"no-slip\"");
  }
}

Boundary read_boundary(const ConfigTable& table, int direction, int side) {
  for (const char* key : {"type", "superficial_velocity", "pressure", "wall_velocity"}) {
    table.has(key);
  }
  table.reject_unknown_keys();
  Boundary boundary;
  boundary.type = type_of(table.choice("type", {"no-slip", "slip", "inlet", "outlet", "periodic"}));
  if (boundary.type == BoundaryType::inlet) {
    boundary.superficial_velocity = read_superficial_velocity(table, direction, side);
  }
  if (boundary.type == BoundaryType::outlet) boundary.pressure = table.number_or("pressure", 0.0);
  if (boundary.type == BoundaryType::no_slip) {
    boundary.wall_velocity = table.vector_or("wall_velocity", Vec3::Zero());
    if (boundary.wall_velocity[direction] != 0.0) {
      table.fail("wall_velocity",
                 "has a component across the side; a side can only slide in its "
                 "own plane");
    }
  }
  reject_keys_of_other_types(table, boundary.type);
  return boundary;
}

}  // namespace

Boundaries read_boundaries(const ConfigTable& boundary_table) {
  static const std::string names[3][2] = {
      {"x_lower", "x_upper"}, {"y_lower", "y_upper"}, {"z_lower", "z_upper"}};
  for (const auto& pair : names) {
    for (const std::string& name : pair) boundary_table.has(name);
  }
  boundary_table.reject_unknown_keys();
  Boundaries boundaries;
  for (int d = 0; d < 3; ++d) {
    for (int side = 0; side < 2; ++side) {
      boundaries[d][side] = read_boundary(boundary_table.table(names[d][side]), d, side);
    }
    const bool lower = boundaries[d][0].type == BoundaryType::periodic;
    const bool upper = boundaries[d][1].type == BoundaryType::periodic;
    if (lower != upper) {
      boundary_table.fail(names[d][lower ? 1 : 0],
                          "must be periodic too, because " + names[d][lower ? 0 : 1] + " is");
    }
  }
  return boundaries;
}

std::array<bool, 3> periodic_directions(const Boundaries& boundaries) {
  std::array<bool, 3> periodic{};
  for (int d = 0; d < 3; ++d) periodic[d] = boundaries[d][0].type == BoundaryType::periodic;
  return periodic;
}

}  // namespace gasgrain::cfd
