// Open fractions by plane cuts: a box that the surface may cross is cut into parts per direction,
// and in each part the surface is the plane of (phi, grad phi) at its centre. The fraction of a
// part is exact (inclusion-exclusion over its corners), so plane walls come out exactly at any
// angle and the error at a curved wall is of the order of (h / parts)^2 / radius.
#include "cfd/open_fraction.hpp"

#include <algorithm>
#include <cmath>

namespace gasgrain::cfd {

namespace {

constexpr int parts_per_direction = 4;
// Components of the normal below this share of the largest are dropped: the fraction changes by its
// square, while the inclusion-exclusion sum would lose digits to cancellation.
constexpr double negligible = 1e-4;

}  // namespace

double plane_cut_fraction(double distance, const Vec3& gradient, const Vec3& half_extent) {
  const Vec3 reach = gradient.cwiseAbs().cwiseProduct(half_extent);
  if (distance >= reach.sum()) return 1.0;
  if (distance <= -reach.sum()) return 0.0;
  double a[3];
  int n = 0;
  for (int d = 0; d < 3; ++d) {
    if (reach[d] > negligible * reach.maxCoeff()) a[n++] = reach[d];
  }
  // volume of { sum a_m t_m > -distance, |t_m| <= 1 } over that of the box
  double sum = 0.0, scale = 1.0;
  for (int m = 0; m < n; ++m) scale *= 2.0 * a[m] * (m + 1);
  for (int corner = 0; corner < 1 << n; ++corner) {
    double height = distance, sign = 1.0;
    for (int m = 0; m < n; ++m) {
      const bool lower = corner >> m & 1;
      height += lower ? -a[m] : a[m];
      if (lower) sign = -sign;
    }
    if (height > 0.0) sum += sign * std::pow(height, n);
  }
  return std::clamp(sum / scale, 0.0, 1.0);
}

double open_fraction(const SignedDistance& shape, const Vec3& centre, const Vec3& half_extent) {
  const double reach = half_extent.norm();
  const double distance = shape.distance(centre);
  if (distance >= reach) return 1.0;
  if (distance <= -reach) return 0.0;
  std::array<int, 3> parts{};
  Vec3 part_half;
  for (int d = 0; d < 3; ++d) {
    parts[d] = half_extent[d] > 0.0 ? parts_per_direction : 1;
    part_half[d] = half_extent[d] / parts[d];
  }
  double sum = 0.0;
  for (int k = 0; k < parts[2]; ++k) {
    for (int j = 0; j < parts[1]; ++j) {
      for (int i = 0; i < parts[0]; ++i) {
        const Vec3 corner_steps(2 * i + 1 - parts[0], 2 * j + 1 - parts[1], 2 * k + 1 - parts[2]);
        const DistanceSample sample = shape.sample(centre + corner_steps.cwiseProduct(part_half));
        sum += plane_cut_fraction(sample.distance, sample.gradient, part_half);
      }
    }
  }
  return sum / (parts[0] * parts[1] * parts[2]);
}

}  // namespace gasgrain::cfd
