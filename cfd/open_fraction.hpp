// Share of a box, a rectangle or a segment that lies outside a body.
#pragma once

#include "coupling/shared/signed_distance.hpp"

namespace gasgrain::cfd {

// Exact share of the box |x_d| <= half_extent[d] on the side distance + gradient . x > 0 of a
// plane. Directions of zero half-extent do not count; a degenerate box is a point.
double plane_cut_fraction(double distance, const Vec3& gradient, const Vec3& half_extent);

// Share of the axis-aligned box (or rectangle: one zero half-extent) about `centre` outside the
// shape, m.
double open_fraction(const SignedDistance& shape, const Vec3& centre, const Vec3& half_extent);

}  // namespace gasgrain::cfd
