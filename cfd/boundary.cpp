#include "cfd/boundary.hpp"

#include <set>

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

void read_inlet(Boundary& boundary, const ConfigTable& table, int direction, int side) {
  boundary.profile = read_inlet_profile(table, direction);
  const bool given = table.has("superficial_velocity");
  boundary.velocity_is_of_profile = boundary.profile.kind == ProfileKind::table && !given;
  if (boundary.velocity_is_of_profile) return;
  boundary.superficial_velocity = read_superficial_velocity(table, direction, side);
}

void read_wall_velocity(Boundary& boundary, const ConfigTable& table, int direction) {
  boundary.wall_velocity = table.vector_or("wall_velocity", Vec3::Zero());
  if (boundary.wall_velocity[direction] == 0.0) return;
  table.fail("wall_velocity",
             "has a component across the side; a side can only slide in its own plane");
}

void read_outlet(Boundary& boundary, const ConfigTable& table) {
  boundary.pressure = table.number_or("pressure", 0.0);
  const bool moving = table.choice_or("backflow", "still", {"still", "moving"}) == "moving";
  boundary.backflow = moving ? Backflow::moving : Backflow::still;
}

void read_drive(Boundary& boundary, const ConfigTable& table, int side) {
  for (const char* key : {"pressure_gradient", "mean_velocity"}) {
    if (side == 1 && table.has(key))
      table.fail(key, "is stated at the lower side of the direction");
  }
  boundary.pressure_gradient = table.number_or("pressure_gradient", 0.0);
  if (!table.has("mean_velocity")) return;
  boundary.mean_velocity = table.number("mean_velocity");
  if (table.has("pressure_gradient")) {
    table.fail("mean_velocity",
               "is given beside pressure_gradient, which follows from it; give one");
  }
}

void read_factor(Boundary& boundary, const ConfigTable& table) {
  if (!table.has("time_table")) return;
  boundary.factor = read_time_table(table.table("time_table"));
  if (boundary.type != BoundaryType::inlet) return;
  for (const double value : boundary.factor.values) {
    if (value >= 0.0) continue;
    table.fail("time_table", "has the factor " + std::to_string(value) +
                                 "; an inlet blows inwards, give values >= 0");
  }
}

struct OwnedKey {
  const char* key;
  BoundaryType owner;
  const char* owner_name;
};

constexpr OwnedKey owned_keys[] = {
    {"superficial_velocity", BoundaryType::inlet, "an inlet; set type = \"inlet\""},
    {"profile", BoundaryType::inlet, "an inlet; set type = \"inlet\""},
    {"profile_along", BoundaryType::inlet, "an inlet; set type = \"inlet\""},
    {"profile_file", BoundaryType::inlet, "an inlet; set type = \"inlet\""},
    {"pressure", BoundaryType::outlet, "an outlet; set type = \"outlet\""},
    {"backflow", BoundaryType::outlet, "an outlet; set type = \"outlet\""},
    {"pressure_gradient", BoundaryType::periodic, "a periodic side; set type = \"periodic\""},
    {"mean_velocity", BoundaryType::periodic, "a periodic side; set type = \"periodic\""},
    {"wall_velocity", BoundaryType::no_slip, "a no-slip side; set type = \"no-slip\""},
};

void reject_keys_of_other_types(const ConfigTable& table, BoundaryType type) {
  for (const OwnedKey& owned : owned_keys) {
    if (type == owned.owner || !table.has(owned.key)) continue;
    table.fail(owned.key, std::string("belongs to ") + owned.owner_name + " or remove it");
  }
  const bool changes = type != BoundaryType::slip && type != BoundaryType::periodic;
  if (!changes && table.has("time_table")) {
    table.fail("time_table",
               "has nothing to change here; it belongs to an inlet, an outlet or a "
               "no-slip side");
  }
}

Boundary read_condition(const ConfigTable& table, int direction, int side,
                        const std::vector<std::string>& types) {
  Boundary boundary;
  boundary.type = type_of(table.choice("type", types));
  reject_keys_of_other_types(table, boundary.type);
  if (boundary.type == BoundaryType::inlet) read_inlet(boundary, table, direction, side);
  if (boundary.type == BoundaryType::outlet) read_outlet(boundary, table);
  if (boundary.type == BoundaryType::periodic) read_drive(boundary, table, side);
  if (boundary.type == BoundaryType::no_slip) read_wall_velocity(boundary, table, direction);
  read_factor(boundary, table);
  return boundary;
}

// Marks the keys of a condition as known, so that a mistyped one is named as such.
void expect_condition(const ConfigTable& table) {
  table.has("type");
  table.has("time_table");
  for (const OwnedKey& owned : owned_keys) table.has(owned.key);
}

Boundary read_side(const ConfigTable& table, int direction, int side) {
  expect_condition(table);
  table.reject_unknown_keys();
  return read_condition(table, direction, side, {"no-slip", "slip", "inlet", "outlet", "periodic"});
}

void read_side_of(BoundaryPatch& patch, const ConfigTable& table, const Boundaries& boundaries) {
  std::vector<std::string> names;
  for (const auto& pair : names_of_sides) names.insert(names.end(), pair, pair + 2);
  const std::string name = table.choice("side", names);
  for (int n = 0; n < 6; ++n) {
    if (names[n] == name) patch.direction = n / 2, patch.side = n % 2;
  }
  if (boundaries[patch.direction][patch.side].type == BoundaryType::periodic) {
    table.fail("side", "is '" + name + "', which is periodic and cannot have patches");
  }
}

BoundaryPatch read_patch(const ConfigTable& table, const Boundaries& boundaries,
                         const std::vector<Body>& bodies, ShapeFileLoader load_file) {
  expect_condition(table);
  BoundaryPatch patch;
  patch.name = table.text("name");
  read_side_of(patch, table, boundaries);
  if (table.has("body")) {
    patch.region = find_body(bodies, table.text("body")).shape;
  } else {
    patch.region = read_shape(table, load_file);
  }
  table.reject_unknown_keys();
  patch.condition =
      read_condition(table, patch.direction, patch.side, {"no-slip", "slip", "inlet", "outlet"});
  return patch;
}

}  // namespace

Boundaries read_boundaries(const ConfigTable& boundary_table) {
  for (const auto& pair : names_of_sides) {
    for (const char* name : pair) boundary_table.has(name);
  }
  boundary_table.has("patch");
  boundary_table.reject_unknown_keys();
  Boundaries boundaries;
  for (int d = 0; d < 3; ++d) {
    for (int side = 0; side < 2; ++side) {
      boundaries[d][side] = read_side(boundary_table.table(names_of_sides[d][side]), d, side);
    }
    const bool lower = boundaries[d][0].type == BoundaryType::periodic;
    const bool upper = boundaries[d][1].type == BoundaryType::periodic;
    if (lower != upper) {
      boundary_table.fail(
          names_of_sides[d][lower ? 1 : 0],
          "must be periodic too, because " + std::string(names_of_sides[d][lower ? 0 : 1]) + " is");
    }
  }
  return boundaries;
}

std::vector<BoundaryPatch> read_patches(const ConfigTable& boundary_table,
                                        const Boundaries& boundaries,
                                        const std::vector<Body>& bodies,
                                        ShapeFileLoader load_file) {
  std::vector<BoundaryPatch> patches;
  std::set<std::string> names;
  for (const ConfigTable& table : boundary_table.tables("patch")) {
    patches.push_back(read_patch(table, boundaries, bodies, load_file));
    if (!names.insert(patches.back().name).second) {
      table.fail("name", "'" + patches.back().name + "' is taken; every patch needs its own name");
    }
  }
  return patches;
}

void check_time_tables(const ConfigTable& boundary_table, const Boundaries& boundaries,
                       const std::vector<BoundaryPatch>& patches, double end_time) {
  const auto check = [&](const std::string& key, const Boundary& condition) {
    if (condition.factor.covers(end_time)) return;
    boundary_table.fail(key, "has a time_table that ends at " +
                                 std::to_string(condition.factor.times.back()) +
                                 " s, but run.end_time is " + std::to_string(end_time) +
                                 " s; add rows or give a period");
  };
  for (int d = 0; d < 3; ++d) {
    for (int side = 0; side < 2; ++side) check(names_of_sides[d][side], boundaries[d][side]);
  }
  for (const BoundaryPatch& patch : patches) {
    check("patch '" + patch.name + "'", patch.condition);
  }
}

std::array<bool, 3> periodic_directions(const Boundaries& boundaries) {
  std::array<bool, 3> periodic{};
  for (int d = 0; d < 3; ++d) periodic[d] = boundaries[d][0].type == BoundaryType::periodic;
  return periodic;
}

}  // namespace gasgrain::cfd
