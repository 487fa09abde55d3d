// Exact shares of a sphere's volume in the cells of a grid.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "coupling/shared/vec3.hpp"

namespace gasgrain::coupling {

// Volume of the part of the unit sphere about the origin with x > corner[0], y > corner[1] and
// z > corner[2], in [0, 4 pi/3] up to round-off. Any real corner.
double sphere_volume_beyond(const Vec3& corner);

// Shares of the unit sphere's volume in the boxes between the planes x = planes[0][i], y =
// planes[1][j], z = planes[2][k]: shares[i + (n0-1) (j + (n1-1) k)], n the numbers of planes, which
// ascend. Planes beyond the sphere are at its surface; shares of boxes that cover the sphere add up
// to 1.
void sphere_shares(std::vector<double>& shares,
                   const std::array<std::span<const double>, 3>& planes);

}  // namespace gasgrain::coupling
