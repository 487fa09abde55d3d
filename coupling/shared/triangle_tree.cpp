// Boxes halved at the median of the longest side; in leaves a few triangles.
//
// Nearest point: nodes whose box is farther than the best so far are skipped. In a triangle it is
// found by the region of the plane (Ericson, Real-Time Collision Detection, 2005, 5.1.5).
//
// Winding number: sum of the signed solid angles of the triangles over 4 pi (van Oosterom and
// Strackee 1983), generalized to any triangles (Jacobson et al. 2013); a node farther away than
// twice its radius counts as a dipole at its centre (Barill et al. 2018, first order):
//
//   w = area . (centre - x) / (4 pi |centre - x|^3)
#include "coupling/shared/triangle_tree.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "coupling/shared/error.hpp"

namespace gasgrain {

namespace {

constexpr int leaf_size = 4;
constexpr double far = 2.0;  // in radii of a node
constexpr int deepest = 64;  // the median halves the count: depth 31 at most

Vec3 nearest_of_triangle(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& x) {
  const Vec3 ab = b - a, ac = c - a, ax = x - a;
  const double d1 = ab.dot(ax), d2 = ac.dot(ax);
  if (d1 <= 0 && d2 <= 0) return a;
  const Vec3 bx = x - b;
  const double d3 = ab.dot(bx), d4 = ac.dot(bx);
  if (d3 >= 0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + d1 / (d1 - d3) * ab;
  const Vec3 cx = x - c;
  const double d5 = ab.dot(cx), d6 = ac.dot(cx);
  if (d6 >= 0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + d2 / (d2 - d6) * ac;
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 >= d3 && d5 >= d6) return b + (d4 - d3) / (d4 - d3 + d5 - d6) * (c - b);
  const double sum = va + vb + vc;
  if (!(sum > 0)) return a;  // without area
  const double scale = 1.0 / sum;
  return a + vb * scale * ab + vc * scale * ac;
}

double square_distance_to_box(const Vec3& lower, const Vec3& upper, const Vec3& x) {
  return (lower - x).cwiseMax(x - upper).cwiseMax(0.0).squaredNorm();
}

// Signed solid angle of a triangle seen from the origin.
double solid_angle(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  const double volume = a.dot(b.cross(c));
  const double rest = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
  return 2.0 * std::atan2(volume, rest);
}

}  // namespace

TriangleTree::TriangleTree(const TriangleMesh& mesh) : TriangleTree(loose_triangles(mesh)) {}

TriangleTree::TriangleTree(std::vector<LooseTriangle> triangles)
    : triangles_(std::move(triangles)) {
  GASGRAIN_ASSERT(!triangles_.empty());
  build(0, static_cast<int>(triangles_.size()));
}

void TriangleTree::summarize(Node& node, int begin, int end) const {
  node.lower = Vec3::Constant(std::numeric_limits<double>::infinity());
  node.upper = -node.lower;
  node.area = node.centre = Vec3::Zero();
  double total = 0.0;
  for (int t = begin; t < end; ++t) {
    const auto& [a, b, c] = triangles_[t];
    node.lower = node.lower.cwiseMin(a).cwiseMin(b).cwiseMin(c);
    node.upper = node.upper.cwiseMax(a).cwiseMax(b).cwiseMax(c);
    const Vec3 area = 0.5 * (b - a).cross(c - a);
    node.area += area;
    node.centre += area.norm() * (a + b + c) / 3.0;
    total += area.norm();
  }
  node.centre = total > 0 ? Vec3(node.centre / total) : Vec3(0.5 * (node.lower + node.upper));
  node.square_radius = 0.0;
  for (int t = begin; t < end; ++t)
    for (const Vec3& corner : triangles_[t])
      node.square_radius = std::max(node.square_radius, (corner - node.centre).squaredNorm());
}

void TriangleTree::build(int begin, int end) {
  const std::size_t own = nodes_.size();
  nodes_.push_back({});
  summarize(nodes_[own], begin, end);
  nodes_[own].begin = begin;
  nodes_[own].end = end;
  if (end - begin <= leaf_size) return;
  int longest;
  (nodes_[own].upper - nodes_[own].lower).maxCoeff(&longest);
  const int middle = begin + (end - begin) / 2;
  std::nth_element(triangles_.begin() + begin, triangles_.begin() + middle,
                   triangles_.begin() + end, [&](const LooseTriangle& p, const LooseTriangle& q) {
                     return p[0][longest] + p[1][longest] + p[2][longest] <
                            q[0][longest] + q[1][longest] + q[2][longest];
                   });
  build(begin, middle);
  nodes_[own].second_child = static_cast<int>(nodes_.size());
  build(middle, end);
}

TriangleTree::Nearest TriangleTree::nearest(const Vec3& x, double limit) const {
  Nearest best{x, limit, Vec3::Zero()};
  struct Waiting {
    int node;
    double square_distance;
  };
  std::array<Waiting, deepest> stack;
  const auto wait = [&](int node) {
    return Waiting{node, square_distance_to_box(nodes_[node].lower, nodes_[node].upper, x)};
  };
  int count = 0, found = -1;
  stack[count++] = wait(0);
  while (count > 0) {
    const Waiting top = stack[--count];
    if (top.square_distance >= best.square_distance) continue;
    const Node& node = nodes_[top.node];
    if (node.second_child == 0) {
      for (int t = node.begin; t < node.end; ++t) {
        const Vec3 point =
            nearest_of_triangle(triangles_[t][0], triangles_[t][1], triangles_[t][2], x);
        const double square = (point - x).squaredNorm();
        if (square >= best.square_distance) continue;
        best.point = point;
        best.square_distance = square;
        found = t;
      }
      continue;
    }
    const Waiting first = wait(top.node + 1), second = wait(node.second_child);
    const bool first_is_nearer = first.square_distance <= second.square_distance;
    stack[count++] = first_is_nearer ? second : first;
    stack[count++] = first_is_nearer ? first : second;
  }
  if (found >= 0) {
    const auto& [a, b, c] = triangles_[found];
    best.normal = (b - a).cross(c - a).normalized();
  }
  return best;
}

double TriangleTree::winding_number(const Vec3& x) const {
  double angle = 0.0;
  std::array<int, deepest> stack;
  int count = 0;
  stack[count++] = 0;
  while (count > 0) {
    const int n = stack[--count];
    const Node& node = nodes_[n];
    const Vec3 offset = node.centre - x;
    const double square = offset.squaredNorm();
    if (square > far * far * node.square_radius) {
      angle += node.area.dot(offset) / (square * std::sqrt(square));
    } else if (node.second_child == 0) {
      for (int t = node.begin; t < node.end; ++t)
        angle += solid_angle(triangles_[t][0] - x, triangles_[t][1] - x, triangles_[t][2] - x);
    } else {
      stack[count++] = node.second_child;
      stack[count++] = n + 1;
    }
  }
  return angle / (4.0 * std::numbers::pi);
}

}  // namespace gasgrain
