#include "coupling/shared/triangle_mesh.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

namespace gasgrain {

namespace {

// Indices of the vertices of loose corners; `vertices` gets one of each place, in sorted order.
std::vector<int> merge_corners(const std::vector<LooseTriangle>& triangles,
                               std::vector<Vec3>& vertices) {
  const auto corner = [&](int n) -> const Vec3& { return triangles[n / 3][n % 3]; };
  std::vector<int> order(3 * triangles.size()), vertex(order.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int m, int n) {
    return std::lexicographical_compare(corner(m).begin(), corner(m).end(), corner(n).begin(),
                                        corner(n).end());
  });
  for (const int n : order) {
    if (vertices.empty() || vertices.back() != corner(n)) vertices.push_back(corner(n));
    vertex[n] = static_cast<int>(vertices.size()) - 1;
  }
  return vertex;
}

// The triangle with its smallest index first; the order round it stays.
std::array<int, 3> rotated(std::array<int, 3> t) {
  std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  return t;
}

}  // namespace

std::vector<LooseTriangle> loose_triangles(const TriangleMesh& mesh) {
  std::vector<LooseTriangle> triangles;
  triangles.reserve(mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    triangles.push_back({mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)});
  return triangles;
}

WeldedMesh weld(const std::vector<LooseTriangle>& triangles) {
  WeldedMesh result;
  const std::vector<int> vertex = merge_corners(triangles, result.mesh.vertices);
  std::map<std::array<int, 3>, int> net;  // facing one way less facing the other, by sorted corners
  std::vector<std::array<int, 3>> proper;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const auto& [a, b, c] = triangles[t];
    if ((b - a).cross(c - a).isZero(0.0)) ++result.degenerate;
    const std::array<int, 3> own = rotated({vertex[3 * t], vertex[3 * t + 1], vertex[3 * t + 2]});
    if (own[0] == own[1] || own[1] == own[2] || own[0] == own[2]) continue;
    std::array<int, 3> sorted = own;
    std::sort(sorted.begin(), sorted.end());
    net[sorted] += sorted == own ? 1 : -1;
    proper.push_back(own);
  }
  for (const std::array<int, 3>& own : proper) {
    std::array<int, 3> sorted = own;
    std::sort(sorted.begin(), sorted.end());
    int& count = net[sorted];
    const int facing = sorted == own ? 1 : -1;
    if (count * facing > 0) {
      result.mesh.triangles.push_back(own);
      count = 0;
    } else {
      ++result.duplicates;
    }
  }
  return result;
}

double enclosed_volume(const TriangleMesh& mesh) {
  double sum = 0.0;
  if (mesh.vertices.empty()) return sum;
  const Vec3 origin = mesh.vertices.front();  // near: less rounding
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    sum += (mesh.corner(t, 0) - origin)
               .dot((mesh.corner(t, 1) - origin).cross(mesh.corner(t, 2) - origin));
  return sum / 6.0;
}

double surface_area(const TriangleMesh& mesh) {
  double sum = 0.0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    sum +=
        (mesh.corner(t, 1) - mesh.corner(t, 0)).cross(mesh.corner(t, 2) - mesh.corner(t, 0)).norm();
  return 0.5 * sum;
}

void turn_round(TriangleMesh& mesh) {
  for (std::array<int, 3>& t : mesh.triangles) std::swap(t[1], t[2]);
}

}  // namespace gasgrain
