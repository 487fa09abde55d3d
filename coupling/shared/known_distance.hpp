// Distances of shapes for which the search is long, helped by what is known at a place nearby.
#pragma once

#include "coupling/shared/signed_distance.hpp"

namespace gasgrain {

struct KnownDistance {
  Vec3 place;       // m
  double distance;  // of the same shape, m
};

// What such shapes offer besides SignedDistance: the same value as distance(x).
class DistanceFromKnown {
 public:
  virtual ~DistanceFromKnown() = default;
  virtual double distance_near(const Vec3& x, const KnownDistance& known) const = 0;
};

// distance(x) of any shape.
inline double distance_near(const SignedDistance& shape, const Vec3& x,
                            const KnownDistance& known) {
  const auto* helped = dynamic_cast<const DistanceFromKnown*>(&shape);
  return helped ? helped->distance_near(x, known) : shape.distance(x);
}

}  // namespace gasgrain
