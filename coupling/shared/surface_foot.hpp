// The place on the surface of a sampled field that is nearest to a point.
#pragma once

#include <optional>

#include "coupling/shared/near_surfaces.hpp"
#include "coupling/shared/sampled_distance.hpp"

namespace gasgrain {

// The wall seen from x whose foot is found from `start` [m], a place near the surface; nothing when
// the field is not resolved there or `start` leads to the farthest place of a hollow. A search that
// does not end is given up and says so (NearWall::foot_found). Of fields with quadratic
// interpolation.
std::optional<NearWall> wall_at_foot(const SampledDistance& field, const Vec3& x,
                                     const Vec3& start);

}  // namespace gasgrain
