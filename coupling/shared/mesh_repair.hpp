// Closed solids that face outwards from triangles as users have them.
#pragma once

#include <vector>

#include "coupling/shared/triangle_mesh.hpp"

namespace gasgrain {

// What was found and done.
struct MeshReport {
  std::size_t triangles = 0;       // as read
  std::size_t degenerate = 0;      // without area
  std::size_t duplicates = 0;      // left out
  std::size_t turned = 0;          // turned round to agree with their neighbours
  std::size_t parts = 0;           // closed surfaces, and those with holes
  std::size_t inverted_parts = 0;  // that were inside out, turned round
  std::size_t cavities = 0;        // closed surfaces within another that face inwards: kept
  std::size_t branched_edges = 0;  // with more than two triangles
  std::size_t open_edges = 0;      // without a partner
  std::size_t holes = 0;           // loops of open edges, closed by a fan of triangles
  double largest_hole = 0.0;       // m, diagonal of the box around it
  double diagonal = 0.0;           // m, of the box around everything
  double area = 0.0;               // m^2
  double volume = 0.0;             // m^3, sum of all solids
};

struct RepairedMesh {
  std::vector<TriangleMesh> solids;  // each closed and outside out; their union is meant
  MeshReport report;
};

// Accepts any triangles. Throws UserError when none is left that has an area.
RepairedMesh repair_mesh(const std::vector<LooseTriangle>& triangles);

}  // namespace gasgrain
