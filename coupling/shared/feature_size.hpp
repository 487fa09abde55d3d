// How thin the walls and how narrow the gaps of a sampled shape are.
#pragma once

#include "coupling/shared/sampled_distance.hpp"

namespace gasgrain {

struct FeatureSize {
  double thinnest_wall = 0.0;  // m; the looked-for length when there is nothing thinner
  double narrowest_gap = 0.0;  // m, the same
  double thin_share = 0.0;     // share of the surface whose wall or gap is below two spacings
  std::size_t rays = 0;
};

// Looks from points spread over the surface along the normal, into the solid and out of it, for the
// next surface of `shape` up to `length` (m). Acute edges count as thin walls. `field`: samples of
// the shape, which tell where its surface is.
FeatureSize feature_size(const SignedDistance& shape, const SampledDistance& field, double length);

}  // namespace gasgrain
