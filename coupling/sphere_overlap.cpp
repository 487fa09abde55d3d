// Volume of the unit sphere beyond one, two and three orthogonal planes, and by sums and
// differences of these in any box of a grid.
//
// A region cut by planes at distances a, b, c >= 0 from the centre is made of rays from the centre
// to its surface, less the cones below its plane faces (divergence theorem with x as the field):
//
//   V = 1/3 (area on the sphere - a A_a - b A_b - c A_c)
//
// The area on the sphere follows from Gauss and Bonnet: 2 pi less the turning along its arcs (an
// arc of angle phi at distance a turns by a phi) and less the exterior angles. Two planes a, b meet
// on the sphere at the interior angle atan2(r_ab, a b), r_ab = sqrt(1 - a^2 - b^2), provided
// a^2 + b^2 < 1; else nothing lies beyond both. Negative distances: what lies beyond -a is all less
// what lies beyond the mirrored plane a. All angles by atan2, exact to round-off also where the
// region vanishes.
// A box is an alternating sum over its eight corners. Over the boxes of a grid these sums
// telescope, so that the shares add up to the sphere to round-off whatever the values at the
// corners.
// Source: derived here; the same volumes in Strobl, Formella, Poschel, J. Comput. Phys. 311 (2016)
// 158.
#include "coupling/sphere_overlap.hpp"

#include <cmath>
#include <numbers>

namespace gasgrain::coupling {

namespace {

constexpr double pi = std::numbers::pi;
constexpr double whole = 4.0 / 3.0 * pi;

double beyond_plane(double a) {
  if (a >= 1) return 0;
  if (a <= -1) return whole;
  return pi / 3 * (1 - a) * (1 - a) * (2 + a);
}

// Half chord of the unit sphere along the line in which planes at distances a and b meet.
double half_chord(double a, double b) {
  return std::sqrt(1 - a * a - b * b);
}

double beyond_planes(double a, double b) {
  if (a >= 1 || b >= 1) return 0;
  if (a < 0) return beyond_plane(b) - beyond_planes(-a, b);
  if (b < 0) return beyond_plane(a) - beyond_planes(a, -b);
  if (a * a + b * b >= 1) return 0;
  const double r = half_chord(a, b);
  return (2 * std::atan2(r, a * b) - a * (3 - a * a) * std::atan2(r, b) -
          b * (3 - b * b) * std::atan2(r, a) + 2 * a * b * r) /
         3;
}

// a phi (3 - a^2)/2: the share of the face at distance a, and of the arc around it, in 3 V; phi is
// the angle of the arc between the points where it meets the planes b and c.
double face_term(double a, double b, double c) {
  const double r_ab = half_chord(a, b), r_ac = half_chord(a, c);
  const double angle = std::atan2(r_ab * r_ac - b * c, r_ac * b + r_ab * c);
  return 0.5 * a * (3 - a * a) * angle;
}

double beyond_planes(double a, double b, double c) {
  if (a >= 1 || b >= 1 || c >= 1) return 0;
  if (a < 0) return beyond_planes(b, c) - beyond_planes(-a, b, c);
  if (b < 0) return beyond_planes(a, c) - beyond_planes(a, -b, c);
  if (c < 0) return beyond_planes(a, b) - beyond_planes(a, b, -c);
  if (a * a + b * b + c * c >= 1) return 0;
  const double r_ab = half_chord(a, b), r_bc = half_chord(b, c), r_ac = half_chord(a, c);
  const double angles =
      std::atan2(r_ab, a * b) + std::atan2(r_bc, b * c) + std::atan2(r_ac, a * c) - pi;
  return (angles + a * b * r_ab + b * c * r_bc + a * c * r_ac - 3 * a * b * c - face_term(a, b, c) -
          face_term(b, c, a) - face_term(c, a, b)) /
         3;
}

}  // namespace

double sphere_volume_beyond(const Vec3& corner) {
  return beyond_planes(corner[0], corner[1], corner[2]);
}

void sphere_shares(std::vector<double>& shares,
                   const std::array<std::span<const double>, 3>& planes) {
  const std::size_t nx = planes[0].size() - 1, ny = planes[1].size() - 1, nz = planes[2].size() - 1;
  shares.assign(nx * ny * nz, 0.0);
  for (std::size_t k = 0; k <= nz; ++k)
    for (std::size_t j = 0; j <= ny; ++j)
      for (std::size_t i = 0; i <= nx; ++i) {
        const double beyond =
            sphere_volume_beyond(Vec3(planes[0][i], planes[1][j], planes[2][k])) / whole;
        // the corner is the lower or the upper one of the boxes around it in each direction
        for (std::size_t above = 0; above < 8; ++above) {
          const std::size_t x = i - (above & 1), y = j - (above >> 1 & 1), z = k - (above >> 2);
          if (x >= nx || y >= ny || z >= nz) continue;  // below zero: wraps to a large number
          const bool odd = ((above & 1) + (above >> 1 & 1) + (above >> 2)) % 2 == 1;
          shares[x + nx * (y + ny * z)] += odd ? -beyond : beyond;
        }
      }
}

}  // namespace gasgrain::coupling
