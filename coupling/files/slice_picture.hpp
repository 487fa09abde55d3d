// A picture of a plane cut through a signed distance field.
#pragma once

#include <string>

#include "coupling/shared/sampled_distance.hpp"

namespace gasgrain {

struct Slice {
  int axis = 1;           // 0, 1, 2: the plane is normal to x, y, z
  double position = 0.0;  // m, along the axis
};

// Writes a PNG: solid grey, flow domain from blue at the wall to white beyond the band, the surface
// black. The longer side has at most `pixels` pixels. The first of the other two axes points right,
// the second up. Throws UserError when the file cannot be written.
void write_slice_picture(const std::string& path, const SampledDistance& field, const Slice& slice,
                         int pixels = 800);

}  // namespace gasgrain
