// Makes a SignedDistance of any plain solid that has `DistanceSample measure(const Solid&, x)`.
#pragma once

#include <memory>
#include <utility>

#include "coupling/shared/signed_distance.hpp"

namespace gasgrain {

template <class Solid>
class MeasuredShape : public SignedDistance {
 public:
  explicit MeasuredShape(Solid solid) : solid_(std::move(solid)) {}
  double distance(const Vec3& x) const override { return measure(solid_, x).distance; }
  DistanceSample sample(const Vec3& x) const override { return measure(solid_, x); }

 protected:
  Solid solid_;
};

}  // namespace gasgrain
