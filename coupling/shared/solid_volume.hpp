// Volume of the solid of a shape within a box.
#pragma once

#include <array>

#include "coupling/shared/signed_distance.hpp"

namespace gasgrain {

// The box is cut into `cells` cubes of edge `spacing`, of which those at the surface are halved
// `halvings` times.
struct VolumeGrid {
  Vec3 lower;
  double spacing;  // m
  std::array<int, 3> cells;
  int halvings;
};

// m^3; the same bits for any number of threads.
double solid_volume(const SignedDistance& shape, const VolumeGrid& grid, int threads = 1);

}  // namespace gasgrain
