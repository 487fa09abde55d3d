#include "coupling/shared/stl_shape.hpp"

#include <cstdio>
#include <filesystem>
#include <numbers>
#include <utility>

#include "coupling/shared/error.hpp"
#include "coupling/shared/mesh_distance.hpp"
#include "coupling/shared/motion.hpp"
#include "coupling/shared/stl_file.hpp"

namespace gasgrain {

namespace {

// A hole of more than this share of the mesh's extent is hardly a defect of the export.
constexpr double large_hole = 0.1;

template <class... Values>
std::string line(const char* format, Values... values) {
  char buffer[200];
  std::snprintf(buffer, sizeof buffer, format, values...);
  return std::string(buffer) + "\n";
}

std::vector<LooseTriangle> read_placed(const StlSource& source) {
  std::vector<LooseTriangle> all;
  for (const std::string& file : source.files) {
    for (const LooseTriangle& triangle : read_stl(file)) {
      all.emplace_back();
      for (int n = 0; n < 3; ++n)
        all.back()[n] = source.rotation * (source.scale * triangle[n]) + source.translation;
    }
  }
  return all;
}

std::string resolved_file(const ConfigTable& table, const std::string& key,
                          const std::string& name) {
  const std::string path = table.resolve_path(name);
  if (!std::filesystem::is_regular_file(path))
    table.fail(key, "names '" + path +
                        "', which is not there; correct the path (relative to the "
                        "case file)");
  return path;
}

Shape make_shape(const std::vector<LooseTriangle>& triangles, double sheet_thickness) {
  if (sheet_thickness > 0) return make_sheet_shape(triangles, sheet_thickness);
  const RepairedMesh mesh = repair_mesh(triangles);
  return make_mesh_shape(mesh, text(mesh.report));
}

}  // namespace

PlacedShape make_stl_shape(const StlSource& source) {
  GASGRAIN_ASSERT(!source.files.empty() && source.scale > 0);
  const std::vector<LooseTriangle> triangles = read_placed(source);
  PlacedShape result{nullptr, triangles.front()[0], triangles.front()[0]};
  for (const LooseTriangle& triangle : triangles) {
    for (const Vec3& corner : triangle) {
      result.lower = result.lower.cwiseMin(corner);
      result.upper = result.upper.cwiseMax(corner);
    }
  }
  try {
    result.shape = make_shape(triangles, source.sheet_thickness);
    return result;
  } catch (const UserError& error) {
    throw UserError("STL file '" + source.files.front() +
                    (source.files.size() > 1 ? "' and others: " : "': ") + error.what());
  }
}

Shape read_stl_shape(const ConfigTable& table) {
  StlSource source;
  if (table.is_list("file")) {
    for (const std::string& name : table.texts("file"))
      source.files.push_back(resolved_file(table, "file", name));
    if (source.files.empty()) table.fail("file", "is an empty list; name at least one STL file");
  } else {
    source.files = {resolved_file(table, "file", table.text("file"))};
  }
  source.scale = table.number_or("scale", 1.0, Range::positive());
  if (table.has("rotation_angle") || table.has("rotation_axis")) {
    const double degrees = table.number("rotation_angle", {.lower = -360, .upper = 360});
    const Vec3 axis = table.vector("rotation_axis");
    if (axis.norm() == 0.0) table.fail("rotation_axis", "must not be zero: it gives a direction");
    source.rotation = rotation_about(axis.normalized(), degrees * std::numbers::pi / 180);
  }
  source.translation = table.vector_or("translation", Vec3::Zero());
  if (table.has("sheet_thickness"))
    source.sheet_thickness = table.number("sheet_thickness", Range::positive());
  try {
    return make_stl_shape(source).shape;
  } catch (const UserError& error) {
    table.fail("file", error.what());
  }
}

std::string text(const MeshReport& report) {
  std::string lines =
      line("mesh           %zu triangles, %zu parts, area %.6g m^2, volume %.8g m^3",
           report.triangles, report.parts, report.area, report.volume);
  const auto note = [&](std::size_t count, const char* what) {
    if (count > 0) lines += line("  %-12zu %s", count, what);
  };
  note(report.degenerate, "triangles without area");
  note(report.duplicates, "triangles that are there more than once, left out");
  note(report.turned, "triangles turned round to agree with their neighbours");
  note(report.inverted_parts, "parts that were inside out, turned round");
  note(report.cavities, "parts that face inwards within another: cavities");
  note(report.branched_edges, "edges with more than two triangles");
  note(report.open_edges, "edges without a partner");
  if (report.holes == 0) return lines;
  lines += line("  %-12zu holes closed, the largest %.4g m across (%.2g %% of the mesh)",
                report.holes, report.largest_hole, 100 * report.largest_hole / report.diagonal);
  if (report.largest_hole > large_hole * report.diagonal)
    lines +=
        "  warning      so large a hole may be an opening: sheet_thickness makes a wall of a "
        "surface and leaves its openings\n";
  return lines;
}

}  // namespace gasgrain
