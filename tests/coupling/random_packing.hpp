// Random packings of equal spheres in a periodic cube.
#pragma once

#include <cmath>
#include <random>
#include <vector>

#include "coupling/shared/vec3.hpp"

namespace gasgrain::coupling {

// Centres of spheres of diameter 1 to about that solid fraction in a cube of `edge`, repeated
// `copies` times per direction. Random places, pushed apart until overlaps are a few per cent of
// the diameter.
inline std::vector<Vec3> random_packing(int edge, double solid_fraction, int copies = 1) {
  const int count = static_cast<int>(solid_fraction * edge * edge * edge * 6 / M_PI);
  std::mt19937 random(2);
  std::uniform_real_distribution<double> place(0.0, edge);
  std::vector<Vec3> at;
  for (int n = 0; n < count; ++n) {
    const double x = place(random), y = place(random), z = place(random);
    at.emplace_back(x, y, z);
  }
  const auto bin = [&](const Vec3& x, int d) { return static_cast<int>(x[d]) % edge; };
  std::vector<std::vector<int>> bins(edge * edge * edge);
  for (int pass = 0; pass < 300; ++pass) {
    for (auto& b : bins) b.clear();
    for (int n = 0; n < count; ++n)
      bins[bin(at[n], 0) + edge * (bin(at[n], 1) + edge * bin(at[n], 2))].push_back(n);
    std::vector<Vec3> push(count, Vec3::Zero());
    for (int n = 0; n < count; ++n) {
      for (int near = 0; near < 27; ++near) {
        const int i = (bin(at[n], 0) + near % 3 - 1 + edge) % edge;
        const int j = (bin(at[n], 1) + near / 3 % 3 - 1 + edge) % edge;
        const int k = (bin(at[n], 2) + near / 9 - 1 + edge) % edge;
        for (const int other : bins[i + edge * (j + edge * k)]) {
          Vec3 apart = at[n] - at[other];
          for (int d = 0; d < 3; ++d) apart[d] -= edge * std::round(apart[d] / edge);
          const double distance = apart.norm();
          if (other == n || distance >= 1 || distance == 0) continue;
          push[n] += 0.3 * (1 - distance) / distance * apart;
        }
      }
    }
    for (int n = 0; n < count; ++n) {
      at[n] += push[n];
      for (int d = 0; d < 3; ++d) at[n][d] -= edge * std::floor(at[n][d] / edge);
    }
  }
  std::vector<Vec3> result;
  for (int copy = 0; copy < copies * copies * copies; ++copy) {
    const Vec3 shift(copy % copies, copy / copies % copies, double(copy / (copies * copies)));
    for (const Vec3& x : at) result.push_back(x + edge * shift);
  }
  return result;
}

}  // namespace gasgrain::coupling
