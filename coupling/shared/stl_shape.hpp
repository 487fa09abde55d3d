// A shape from STL files: placed, repaired, as a solid or as a sheet of given thickness.
#pragma once

#include <string>
#include <vector>

#include "coupling/shared/config_table.hpp"
#include "coupling/shared/mesh_repair.hpp"
#include "coupling/shared/signed_distance.hpp"

namespace gasgrain {

struct StlSource {
  std::vector<std::string> files;    // at least one; their union is meant
  double scale = 1.0;                // m per unit of the files, > 0
  Mat3 rotation = Mat3::Identity();  // after scaling
  Vec3 translation = Vec3::Zero();   // m, after rotation
  double sheet_thickness = 0.0;      // m; > 0: a sheet along the surface, not what it encloses
};

// The shape and where it is. Corners x of the files become rotation * (scale * x) + translation.
// Throws UserError when a file cannot be read or holds no surface.
struct PlacedShape {
  Shape shape;
  Vec3 lower, upper;  // box around the surface, m
};
PlacedShape make_stl_shape(const StlSource& source);

// Reads the `stl` table of a body (keys: docs/geometry.md). Throws UserError: no file of that name,
// values out of range, zero axis, what make_stl_shape() refuses.
Shape read_stl_shape(const ConfigTable& table);

// What was found in a mesh and mended, as lines for the user: one about the whole, and one per
// kind of defect.
std::string text(const MeshReport& report);

}  // namespace gasgrain
