// The contacts of a ball with a shape.
#pragma once

#include "coupling/shared/signed_distance.hpp"

namespace gasgrain {

// Normals that differ by less than this angle (20 degrees, its cosine) are one contact.
inline constexpr double same_normal = 0.94;

// The places where a ball at x touches the surface, the nearest first: those with phi < radius,
// each with a normal of its own. `nearest` is shape.sample(x). When x itself is within the solid
// the nearest alone.
NearSurfaces ball_contacts(const SignedDistance& shape, const DistanceSample& nearest,
                           const Vec3& x, double radius);

}  // namespace gasgrain
