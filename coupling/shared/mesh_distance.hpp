// Signed distance to triangle meshes: exact, but slower than a sampled field.
#pragma once

#include <string>
#include <vector>

#include "coupling/shared/mesh_repair.hpp"
#include "coupling/shared/signed_distance.hpp"

namespace gasgrain {

// The union of the solids of a repaired mesh. Distance to the nearest triangle (those of `solids`
// closed holes included), sign by winding number; where a solid intersects itself, |phi| inside is
// that to the nearest of its triangles and so too small.
// `remarks`: what remarks() of the shape returns.
Shape make_mesh_shape(const RepairedMesh& mesh, std::string remarks);

// Everything nearer than half of `thickness` (m) to any of the triangles: surfaces without
// thickness become walls, open ones stay open.
Shape make_sheet_shape(const std::vector<LooseTriangle>& triangles, double thickness);

}  // namespace gasgrain
