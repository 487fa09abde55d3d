#include "cfd/probe_case.hpp"

#include <algorithm>
#include <cctype>
#include <set>

#include "coupling/shared/text.hpp"

namespace gasgrain::cfd {

namespace {

const std::vector<std::string> places{"point", "line", "plane", "box", "body"};

void expect_only(const ConfigTable& table, const std::vector<std::string>& keys) {
  for (const std::string& key : keys) table.has(key);
  table.reject_unknown_keys();
}

Vec3 point_in_grid(const ConfigTable& table, const std::string& key, const Grid& grid) {
  const Vec3 x = table.vector(key);
  if ((x - grid.lower).minCoeff() >= 0.0 && (grid.upper - x).minCoeff() >= 0.0) return x;
  table.fail(key, "is " + text(x) + ", outside the grid from " + text(grid.lower) + " to " +
                      text(grid.upper) + " m");
}

LineProbe read_line(const ConfigTable& table, const Grid& grid) {
  expect_only(table, {"from", "to", "samples"});
  return {point_in_grid(table, "from", grid), point_in_grid(table, "to", grid),
          static_cast<int>(table.integer("samples", {.lower = 2, .upper = 100000}))};
}

PlaneProbe read_plane(const ConfigTable& table, const Grid& grid) {
  expect_only(table, {"direction", "position"});
  const std::string name = table.choice("direction", {"x", "y", "z"});
  const int d = name[0] - 'x';
  return {d, table.number("position", {.lower = grid.lower[d], .upper = grid.upper[d]})};
}

BoxProbe read_box(const ConfigTable& table, const Grid& grid) {
  expect_only(table, {"lower", "upper"});
  const BoxProbe box{point_in_grid(table, "lower", grid), point_in_grid(table, "upper", grid)};
  if (!((box.upper - box.lower).minCoeff() > 0.0)) {
    table.fail("upper", "is " + text(box.upper) + ", but must exceed lower = " + text(box.lower) +
                            " in every component");
  }
  return box;
}

BodyProbe read_body(const ConfigTable& table, const std::vector<Body>& bodies) {
  std::vector<std::string> names;
  for (const Body& body : bodies) names.push_back(body.name);
  const std::string name = table.choice("body", names);
  return {name,
          static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin())};
}

std::string read_name(const ConfigTable& table) {
  const std::string name = table.text("name");
  const bool plain = std::all_of(name.begin(), name.end(), [](unsigned char c) {
    return std::isalnum(c) || c == '_' || c == '-';
  });
  if (name.empty() || !plain) {
    table.fail("name", "is '" + name +
                           "', but becomes part of a file name: use letters, digits, '_' and '-'");
  }
  return name;
}

ProbeSettings read_probe(const ConfigTable& table, const Grid& grid,
                         const std::vector<Body>& bodies) {
  expect_only(table, {"name", "interval", "point", "line", "plane", "box", "body"});
  ProbeSettings probe;
  probe.name = read_name(table);
  probe.interval = table.number_or("interval", probe.interval, Range::non_negative());
  const auto stated =
      std::count_if(places.begin(), places.end(), [&](const auto& key) { return table.has(key); });
  if (stated != 1) {
    table.fail("name", "'" + probe.name + "' has " + std::to_string(stated) +
                           " places, but must have exactly one of: point, line, plane, box, body");
  }
  if (table.has("point")) probe.place = PointProbe{point_in_grid(table, "point", grid)};
  if (table.has("line")) probe.place = read_line(table.table("line"), grid);
  if (table.has("plane")) probe.place = read_plane(table.table("plane"), grid);
  if (table.has("box")) probe.place = read_box(table.table("box"), grid);
  if (table.has("body")) probe.place = read_body(table, bodies);
  return probe;
}

}  // namespace

std::vector<ProbeSettings> read_probes(const ConfigTable& file, const Grid& grid,
                                       const std::vector<Body>& bodies) {
  std::vector<ProbeSettings> probes;
  std::set<std::string> names;
  for (const ConfigTable& table : file.tables("probe")) {
    probes.push_back(read_probe(table, grid, bodies));
    if (!names.insert(probes.back().name).second) {
      table.fail("name", "'" + probes.back().name + "' is used twice; give each probe its own");
    }
  }
  return probes;
}

}  // namespace gasgrain::cfd
