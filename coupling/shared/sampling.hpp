// Makes a sampled field of a shape and checks that a sampled field describes a closed solid.
#pragma once

#include <functional>
#include <string>

#include "coupling/shared/sampled_distance.hpp"

namespace gasgrain {

// compact: 2 bytes per sample instead of 4, rounded to (band + 10 spacings)/32767.
enum class SampleStorage { plain, compact };

struct SamplingBox {
  Vec3 lower;
  Vec3 upper;      // rounded up to whole bricks of 4 samples
  double spacing;  // m
  double band;     // |phi| up to here is resolved, m
  bool cut;        // the body may end at the sides of the box
  Interpolation interpolation = Interpolation::linear;
  SampleStorage storage = SampleStorage::plain;
};

// Width of the band unless the user gives one.
inline double default_band(double spacing) {
  return 8.0 * spacing;
}

struct SamplingEffort {
  int threads = 1;
  std::function<void(double share)> progress;  // called by one thread at a time; may be empty
};

// Samples `shape`, which must not change faster than distance does (|grad phi| <= 1), as primitives
// and booleans do. The result does not depend on the number of threads. Throws UserError when the
// box is empty, would need too many bricks, or the band is wider than what `shape` resolves.
SampledDistance sample_shape(const SignedDistance& shape, const SamplingBox& box,
                             const SamplingEffort& effort = {});

// Throws UserError "<name>: body not closed ..." when the field cannot be the signed distance of a
// closed solid: neighbouring values differ by more than their spacing, so that the sign changes
// where no surface is; solid or gas is missing altogether; or the surface ends at the sides of the
// sampled box and the field does not say that this is meant (`cut`).
void check_closed(const SampledDistance& field, const std::string& name);

}  // namespace gasgrain
