// Signed distance of a solid body: the one geometry interface for grains and gas.
//
// Sign (eq 17): distance > 0 outside the body, where grains and gas are; < 0 inside the solid.
// A vessel is the complement of its interior.
#pragma once

#include <array>
#include <limits>
#include <memory>
#include <string>

#include "coupling/shared/vec3.hpp"

namespace gasgrain {

struct DistanceSample {
  double distance;  // m
  Vec3 gradient;    // exact derivative of `distance` as returned, points into the flow domain
};

// Places where a ball may touch the surface: locally nearest parts of it, seen from one point.
struct NearSurfaces {
  static constexpr int most = 8;
  int count = 0;
  std::array<DistanceSample, most> surface;

  // Further ones than `most` are dropped.
  void add(const DistanceSample& sample) {
    if (count < most) surface[count++] = sample;
  }
};

class SignedDistance {
 public:
  virtual ~SignedDistance() = default;
  // Signed distance at x [m]. A union or intersection may underestimate |distance| away from the
  // surface, never overestimate it beyond the distance of its nearest part.
  virtual double distance(const Vec3& x) const = 0;
  // Distance and its exact gradient, so that the potential 1/2 k (r - phi)^2 gives a conservative
  // force (eq 18-20).
  virtual DistanceSample sample(const Vec3& x) const = 0;
  // Below this |distance| the field is resolved; a sampled field stores only a band around the
  // surface and beyond it returns a bound with gradient zero. A grain radius must not exceed it. m.
  virtual double resolved_range() const { return std::numeric_limits<double>::infinity(); }
  // The distance changes by no more than this times the way. Interpolated fields may exceed 1.
  virtual double steepest_gradient() const { return 1.0; }
  // Whether a ball can touch the surface at several places (concave edges).
  virtual bool has_several_contacts() const { return false; }
  // Adds the locally nearest parts of the surface with |phi| < reach (m), as distance and normal of
  // each. One for smooth and convex surfaces; at a concave edge one for each side.
  virtual void add_near_surfaces(const Vec3& x, double reach, NearSurfaces& found) const {
    const DistanceSample nearest = sample(x);
    if (nearest.distance < reach && nearest.distance > -reach) found.add(nearest);
  }
  // What the user should know about how the shape was made, in lines; or empty.
  virtual std::string remarks() const { return {}; }
};

using Shape = std::shared_ptr<const SignedDistance>;

}  // namespace gasgrain
