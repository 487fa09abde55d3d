// Closed surfaces of known volume as loose triangles, facing outwards.
#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "coupling/shared/triangle_mesh.hpp"

namespace gasgrain {

using Triangles = std::vector<LooseTriangle>;

inline void add_quad(Triangles& list, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  list.push_back({a, b, c});
  list.push_back({a, c, d});
}

inline Triangles box_triangles(const Vec3& lower, const Vec3& upper) {
  Triangles list;
  for (int d = 0; d < 3; ++d) {
    const int u = (d + 1) % 3, v = (d + 2) % 3;
    const auto corner = [&](double at, bool far_u, bool far_v) {
      Vec3 x;
      x[d] = at;
      x[u] = far_u ? upper[u] : lower[u];
      x[v] = far_v ? upper[v] : lower[v];
      return x;
    };
    const auto side = [&](double at, bool first, bool second) {
      add_quad(list, corner(at, false, false), corner(at, first, second), corner(at, true, true),
               corner(at, second, first));
    };
    side(upper[d], true, false);
    side(lower[d], false, true);
  }
  return list;
}

// A globe of `n` rings of 2n pieces.
inline Triangles ball_triangles(const Vec3& centre, double radius, int n) {
  const auto point = [&](int ring, int piece) {
    const double polar = std::numbers::pi * ring / n, angle = std::numbers::pi * piece / n;
    const double sine = ring == 0 || ring == n ? 0.0 : std::sin(polar);
    return Vec3(centre +
                radius * Vec3(sine * std::cos(angle), sine * std::sin(angle), std::cos(polar)));
  };
  Triangles list;
  for (int r = 0; r < n; ++r) {
    for (int p = 0; p < 2 * n; ++p) {
      const int q = (p + 1) % (2 * n);
      if (r > 0) list.push_back({point(r, p), point(r + 1, p), point(r, q)});
      if (r + 1 < n) list.push_back({point(r + 1, p), point(r + 1, q), point(r, q)});
    }
  }
  return list;
}

inline LooseTriangle turned(const LooseTriangle& t) {
  return {t[0], t[2], t[1]};
}

inline Triangles turned(Triangles list) {
  for (LooseTriangle& t : list) t = turned(t);
  return list;
}

inline Triangles both(Triangles list, const Triangles& more) {
  list.insert(list.end(), more.begin(), more.end());
  return list;
}

}  // namespace gasgrain
