#include "coupling/monitor_options.hpp"

#include <algorithm>
#include <cctype>
#include <set>

namespace gasgrain::coupling {

namespace {

FluxPlane read_plane(const ConfigTable& table, const cfd::Grid& grid) {
  FluxPlane plane;
  plane.name = table.text("name");
  const bool plain = std::all_of(plane.name.begin(), plane.name.end(),
                                 [](unsigned char c) { return std::isalnum(c) || c == '_'; });
  if (plane.name.empty() || !plain) {
    table.fail("name", "is '" + plane.name +
                           "', but becomes part of column names: use letters, digits and '_'");
  }
  plane.direction = table.choice("direction", {"x", "y", "z"})[0] - 'x';
  const int d = plane.direction;
  plane.position = table.number("position", {.lower = grid.lower[d], .upper = grid.upper[d]});
  table.reject_unknown_keys();
  return plane;
}

}  // namespace

MonitorOptions read_monitor_options(const ConfigTable& table, const cfd::Grid& grid) {
  MonitorOptions options;
  options.profile = table.flag_or("profile", options.profile);
  options.bubble_void_fraction =
      table.number_or("bubble_void_fraction", 0.0,
                      {.lower = 0, .upper = 1, .lower_open = true, .upper_open = true});
  if (table.has("mixing"))
    options.mixing_direction = table.choice("mixing", {"x", "y", "z"})[0] - 'x';
  std::set<std::string> names;
  for (const ConfigTable& plane : table.tables("plane")) {
    options.planes.push_back(read_plane(plane, grid));
    if (!names.insert(options.planes.back().name).second)
      plane.fail("name", "'" + options.planes.back().name + "' is used twice");
  }
  table.reject_unknown_keys();
  return options;
}

}  // namespace gasgrain::coupling
