// A tree of boxes over triangles: nearest point and winding number of a place.
#pragma once

#include <vector>

#include "coupling/shared/triangle_mesh.hpp"

namespace gasgrain {

class TriangleTree {
 public:
  explicit TriangleTree(const TriangleMesh& mesh);
  // At least one triangle.
  explicit TriangleTree(std::vector<LooseTriangle> triangles);

  struct Nearest {
    Vec3 point;              // on the surface
    double square_distance;  // m^2
    Vec3 normal;             // unit normal of its triangle
  };
  // Nearest point of the surface, if nearer than `limit` (m^2); else `square_distance` = limit.
  Nearest nearest(const Vec3& x, double limit) const;

  // How often the surface winds around x: 1 inside and 0 outside of a simple closed surface.
  // Approximate: far parts count as dipoles; the error is a few hundredths.
  double winding_number(const Vec3& x) const;

  const Vec3& lower() const { return nodes_.front().lower; }
  const Vec3& upper() const { return nodes_.front().upper; }

 private:
  struct Node {
    Vec3 lower, upper;     // box of the triangles
    Vec3 area;             // sum of their area vectors, m^2
    Vec3 centre;           // of that area
    double square_radius;  // about the centre, m^2
    int begin, end;        // triangles of a leaf
    int second_child;      // the first is the next node; 0: leaf
  };

  void build(int begin, int end);
  void summarize(Node& node, int begin, int end) const;

  std::vector<LooseTriangle> triangles_;
  std::vector<Node> nodes_;
};

}  // namespace gasgrain
