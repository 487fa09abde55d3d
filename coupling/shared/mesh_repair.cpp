// Repair in five steps, each of which leaves a sound mesh alone:
//
//   1 weld equal corners, leave out duplicates
//   2 turn triangles until neighbours (two triangles at an edge) agree; the side to which most of a
//     patch's area faced wins
//   3 a closed patch that is inside out is turned; one that lies within another closed patch and
//     faces the other way is a cavity of it
//   4 patches with open edges: the edges without partner form loops (the boundary of a boundary
//     is empty), and each loop is closed by a fan about its centroid
//   5 each closed patch with its cavities is a solid, all others together are one more
//
// After 4 every edge has as many triangles one way as the other, so that the winding number of a
// solid is an integer everywhere, whatever intersects, and "inside" is winding number >= 1.
// Not recognized: a patch that is inside out within another one, which looks like a cavity.
#include "coupling/shared/mesh_repair.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <tuple>
#include <utility>

#include "coupling/shared/error.hpp"
#include "coupling/shared/triangle_tree.hpp"

namespace gasgrain {

namespace {

struct HalfEdge {
  int low, high;  // vertices
  int triangle;
  bool forward;  // from low to high
};

std::vector<HalfEdge> half_edges(const TriangleMesh& mesh) {
  std::vector<HalfEdge> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
    for (int n = 0; n < 3; ++n) {
      const int from = mesh.triangles[t][n], to = mesh.triangles[t][(n + 1) % 3];
      edges.push_back({std::min(from, to), std::max(from, to), t, from < to});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const HalfEdge& p, const HalfEdge& q) {
    return std::tie(p.low, p.high, p.triangle) < std::tie(q.low, q.high, q.triangle);
  });
  return edges;
}

// Calls visit(begin, end) for the half edges of each edge.
template <class Visit>
void for_each_edge(const std::vector<HalfEdge>& edges, const Visit& visit) {
  for (auto begin = edges.begin(); begin != edges.end();) {
    const auto end = std::find_if(begin, edges.end(), [&](const HalfEdge& e) {
      return e.low != begin->low || e.high != begin->high;
    });
    visit(begin, end);
    begin = end;
  }
}

// Step 2. Returns the patch of each triangle and turns triangles of `mesh`.
class Orientation {
 public:
  Orientation(TriangleMesh& mesh, MeshReport& report) : mesh_(mesh) {
    neighbours_.resize(mesh.triangles.size());
    for_each_edge(half_edges(mesh), [&](auto begin, auto end) {
      if (end - begin > 2) ++report.branched_edges;
      if (end - begin != 2) return;
      const bool agree = begin->forward != (begin + 1)->forward;
      neighbours_[begin->triangle].push_back({(begin + 1)->triangle, agree});
      neighbours_[(begin + 1)->triangle].push_back({begin->triangle, agree});
    });
    patch.assign(mesh.triangles.size(), -1);
    for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t)
      if (patch[t] < 0) report.turned += grow_patch(t);
  }

  std::vector<int> patch;
  int patches = 0;

 private:
  struct Neighbour {
    int triangle;
    bool agrees;
  };

  // Returns the number of triangles turned.
  std::size_t grow_patch(int seed) {
    std::vector<int> members{seed};
    std::vector<bool> turn{false};
    patch[seed] = patches;
    double kept_area = 0.0, turned_area = 0.0;
    for (std::size_t n = 0; n < members.size(); ++n) {
      (turn[n] ? turned_area : kept_area) += area(members[n]);
      for (const Neighbour& next : neighbours_[members[n]]) {
        if (patch[next.triangle] >= 0) continue;
        patch[next.triangle] = patches;
        members.push_back(next.triangle);
        turn.push_back(turn[n] != !next.agrees);
      }
    }
    ++patches;
    std::size_t turned = 0;
    const bool turn_others = turned_area > kept_area;
    for (std::size_t n = 0; n < members.size(); ++n) {
      if (turn[n] == turn_others) continue;
      std::swap(mesh_.triangles[members[n]][1], mesh_.triangles[members[n]][2]);
      ++turned;
    }
    return turned;
  }
  double area(int t) const {
    const Vec3 a = mesh_.corner(t, 0);
    return (mesh_.corner(t, 1) - a).cross(mesh_.corner(t, 2) - a).norm();
  }

  TriangleMesh& mesh_;
  std::vector<std::vector<Neighbour>> neighbours_;
};

// Directed edges without a partner the other way.
std::vector<std::pair<int, int>> open_edges(const TriangleMesh& mesh) {
  std::vector<std::pair<int, int>> open;
  for_each_edge(half_edges(mesh), [&](auto begin, auto end) {
    int net = 0;
    for (auto e = begin; e != end; ++e) net += e->forward ? 1 : -1;
    for (; net > 0; --net) open.push_back({begin->low, begin->high});
    for (; net < 0; ++net) open.push_back({begin->high, begin->low});
  });
  return open;
}

// Step 4. Walks along open edges; whenever the path meets itself a loop is cut off and closed.
class HoleFiller {
 public:
  HoleFiller(TriangleMesh& mesh, MeshReport& report) : mesh_(mesh), report_(report) {}

  void fill() {
    const auto open = open_edges(mesh_);
    report_.open_edges = open.size();
    for (const auto& [from, to] : open) next_[from].push_back(to);
    for (const auto& [from, to] : open) walk(from);
  }

 private:
  void walk(int start) {
    std::vector<int> path;
    std::map<int, std::size_t> place;  // of a vertex in the path
    for (int at = start;;) {
      const auto met = place.find(at);
      if (met != place.end()) {
        const std::size_t first = met->second;
        close({path.begin() + static_cast<std::ptrdiff_t>(first), path.end()});
        for (std::size_t n = first; n < path.size(); ++n) place.erase(path[n]);
        path.resize(first);
      }
      std::vector<int>& ways = next_[at];
      if (ways.empty()) break;
      place[at] = path.size();
      path.push_back(at);
      at = ways.back();
      ways.pop_back();
    }
    GASGRAIN_ASSERT(path.empty());
  }

  void close(const std::vector<int>& loop) {
    Vec3 centre = Vec3::Zero(), lower = mesh_.vertices[loop[0]], upper = lower;
    for (const int v : loop) {
      centre += mesh_.vertices[v] / static_cast<double>(loop.size());
      lower = lower.cwiseMin(mesh_.vertices[v]);
      upper = upper.cwiseMax(mesh_.vertices[v]);
    }
    ++report_.holes;
    report_.largest_hole = std::max(report_.largest_hole, (upper - lower).norm());
    if (loop.size() == 3) {
      mesh_.triangles.push_back({loop[0], loop[2], loop[1]});
      return;
    }
    const int hub = static_cast<int>(mesh_.vertices.size());
    mesh_.vertices.push_back(centre);
    for (std::size_t n = 0; n < loop.size(); ++n)
      mesh_.triangles.push_back({loop[(n + 1) % loop.size()], loop[n], hub});
  }

  TriangleMesh& mesh_;
  MeshReport& report_;
  std::map<int, std::vector<int>> next_;
};

// A closed patch and how it lies among the others.
struct ClosedPatch {
  TriangleMesh mesh;  // facing outwards
  double volume;      // m^3, of that
  bool was_inside_out;
  std::unique_ptr<TriangleTree> tree;
  int container = -1;  // the smallest patch around it
  bool cavity = false;
  int solid = -1;
};

ClosedPatch closed_patch(TriangleMesh mesh) {
  const double volume = enclosed_volume(mesh);
  if (volume < 0) turn_round(mesh);
  auto tree = std::make_unique<TriangleTree>(mesh);
  return {std::move(mesh), std::abs(volume), volume < 0, std::move(tree)};
}

bool contains(const ClosedPatch& outer, const ClosedPatch& inner) {
  if (inner.volume >= outer.volume) return false;
  if ((inner.tree->lower().array() < outer.tree->lower().array()).any() ||
      (inner.tree->upper().array() > outer.tree->upper().array()).any())
    return false;
  constexpr std::size_t asked = 5;  // corners here and there; most of them decide
  std::size_t inside = 0;
  const std::size_t count = inner.mesh.triangles.size();
  for (std::size_t n = 0; n < asked; ++n)
    inside += outer.tree->winding_number(inner.mesh.corner(n * count / asked, 0)) > 0.5;
  return 2 * inside > asked;
}

void append(const TriangleMesh& more, TriangleMesh& mesh) {
  const int offset = static_cast<int>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), more.vertices.begin(), more.vertices.end());
  for (const auto& [a, b, c] : more.triangles)
    mesh.triangles.push_back({a + offset, b + offset, c + offset});
}

// Steps 3 and 5 for closed patches.
void gather_solids(std::vector<ClosedPatch>& patches, RepairedMesh& result) {
  std::stable_sort(patches.begin(), patches.end(),
                   [](const ClosedPatch& p, const ClosedPatch& q) { return p.volume > q.volume; });
  for (std::size_t n = 0; n < patches.size(); ++n) {
    ClosedPatch& patch = patches[n];
    for (std::size_t m = 0; m < n; ++m)
      if (contains(patches[m], patch)) patch.container = static_cast<int>(m);
    const ClosedPatch* container = patch.container >= 0 ? &patches[patch.container] : nullptr;
    patch.cavity =
        container && (container->cavity != (container->was_inside_out != patch.was_inside_out));
    if (patch.cavity) {
      patch.solid = container->solid;
      turn_round(patch.mesh);
      ++result.report.cavities;
    } else {
      patch.solid = static_cast<int>(result.solids.size());
      result.solids.emplace_back();
      result.report.inverted_parts += patch.was_inside_out;
    }
    append(patch.mesh, result.solids[patch.solid]);
  }
}

// Triangles of `all` as a mesh with the vertices they use.
TriangleMesh compact(const std::vector<std::array<int, 3>>& triangles,
                     const std::vector<Vec3>& all) {
  std::vector<int> used;
  for (const std::array<int, 3>& t : triangles) used.insert(used.end(), t.begin(), t.end());
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  TriangleMesh result;
  for (const int v : used) result.vertices.push_back(all[v]);
  for (std::array<int, 3> t : triangles) {
    for (int& v : t)
      v = static_cast<int>(std::lower_bound(used.begin(), used.end(), v) - used.begin());
    result.triangles.push_back(t);
  }
  return result;
}

std::vector<std::vector<std::array<int, 3>>> patch_triangles(const TriangleMesh& mesh,
                                                             const Orientation& orientation) {
  std::vector<std::vector<std::array<int, 3>>> patches(orientation.patches);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    patches[orientation.patch[t]].push_back(mesh.triangles[t]);
  return patches;
}

void close_open_patches(TriangleMesh mesh, RepairedMesh& result) {
  HoleFiller(mesh, result.report).fill();
  if (enclosed_volume(mesh) < 0) {
    turn_round(mesh);
    ++result.report.inverted_parts;
  }
  ++result.report.parts;
  result.solids.push_back(std::move(mesh));
}

}  // namespace

RepairedMesh repair_mesh(const std::vector<LooseTriangle>& triangles) {
  RepairedMesh result;
  WeldedMesh welded = weld(triangles);
  TriangleMesh& mesh = welded.mesh;
  result.report.triangles = triangles.size();
  result.report.degenerate = welded.degenerate;
  result.report.duplicates = welded.duplicates;
  if (!(surface_area(mesh) > 0)) {
    throw UserError("all " + std::to_string(triangles.size()) +
                    " triangles have no area or cancel each other; export the surface again");
  }
  result.report.area = surface_area(mesh);

  const Orientation orientation(mesh, result.report);
  std::vector<ClosedPatch> closed;
  std::vector<std::array<int, 3>> open;
  for (const auto& patch : patch_triangles(mesh, orientation)) {
    TriangleMesh part = compact(patch, mesh.vertices);
    if (open_edges(part).empty() && enclosed_volume(part) != 0.0)
      closed.push_back(closed_patch(std::move(part)));
    else
      open.insert(open.end(), patch.begin(), patch.end());
  }
  result.report.parts = closed.size();
  gather_solids(closed, result);
  if (!open.empty()) close_open_patches(compact(open, mesh.vertices), result);
  Vec3 lower = mesh.vertices.front(), upper = lower;
  for (const Vec3& v : mesh.vertices) {
    lower = lower.cwiseMin(v);
    upper = upper.cwiseMax(v);
  }
  result.report.diagonal = (upper - lower).norm();
  for (const TriangleMesh& solid : result.solids) result.report.volume += enclosed_volume(solid);
  return result;
}

}  // namespace gasgrain
