// Triangles with shared vertices.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "coupling/shared/vec3.hpp"

namespace gasgrain {

// A loose triangle, as STL files hold them; corners counterclockwise seen from outside, m.
using LooseTriangle = std::array<Vec3, 3>;

struct TriangleMesh {
  std::vector<Vec3> vertices;                 // m
  std::vector<std::array<int, 3>> triangles;  // indices of `vertices`

  Vec3 corner(std::size_t triangle, int which) const {
    return vertices[triangles[triangle][which]];
  }
};

std::vector<LooseTriangle> loose_triangles(const TriangleMesh& mesh);

// Vertices at exactly the same place become one. Triangles with two corners in one place are left
// out; of triangles that are there several times, as many as are left when opposite ones cancel, at
// most one.
struct WeldedMesh {
  TriangleMesh mesh;
  std::size_t degenerate = 0;  // triangles without area
  std::size_t duplicates = 0;  // triangles left out because they were there more than once
};
WeldedMesh weld(const std::vector<LooseTriangle>& triangles);

// 1/6 of the sum of a . (b x c): the volume within a closed mesh that faces outwards, m^3.
double enclosed_volume(const TriangleMesh& mesh);
double surface_area(const TriangleMesh& mesh);  // m^2

void turn_round(TriangleMesh& mesh);

}  // namespace gasgrain
