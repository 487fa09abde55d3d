// Signed distance of the primitive solids (eq 17), positive outside.
//
// Each distance is the exact Euclidean one on both sides of the surface: outside an edge or corner
// it is the distance to that edge or corner, inside it is the distance to the nearest face. The
// gradient is the derivative of that value and a unit vector everywhere.
#include "coupling/shared/primitives.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "coupling/shared/measured_shape.hpp"

namespace gasgrain {

namespace {

// A unit vector perpendicular to the unit vector `axis`.
Vec3 perpendicular(const Vec3& axis) {
  int smallest;
  axis.cwiseAbs().minCoeff(&smallest);
  return (Vec3::Unit(smallest) - axis[smallest] * axis).normalized();
}

}  // namespace

DistanceSample measure(const Plane& plane, const Vec3& x) {
  return {(x - plane.point).dot(plane.normal), plane.normal};
}

DistanceSample measure(const Box& box, const Vec3& x) {
  const Vec3 local = box.axes.transpose() * (x - box.center);
  const Vec3 excess = local.cwiseAbs() - box.half_size;  // > 0: beyond the pair of faces
  int nearest;
  const double largest = excess.maxCoeff(&nearest);
  double distance = largest;
  Vec3 gradient = Vec3::Unit(nearest);
  if (largest > 0) {
    const Vec3 beyond = excess.cwiseMax(0.0);
    distance = beyond.norm();
    gradient = beyond / distance;
  }
  for (int d = 0; d < 3; ++d) gradient[d] = std::copysign(gradient[d], local[d]);
  return {distance, box.axes * gradient};
}

DistanceSample measure(const Cylinder& cylinder, const Vec3& x) {
  const Vec3 offset = x - cylinder.center;
  const double height = offset.dot(cylinder.axis);
  const Vec3 radial = offset - height * cylinder.axis;
  const double radius = radial.norm();
  const Vec3 outward = radius > 0 ? Vec3(radial / radius) : perpendicular(cylinder.axis);
  const Vec3 along = std::copysign(1.0, height) * cylinder.axis;
  const double beyond_mantle = radius - cylinder.radius;
  const double beyond_end = std::abs(height) - cylinder.half_length;
  if (beyond_mantle > 0 && beyond_end > 0) {
    const double distance = std::hypot(beyond_mantle, beyond_end);
    return {distance, (beyond_mantle * outward + beyond_end * along) / distance};
  }
  if (beyond_end > beyond_mantle) return {beyond_end, along};
  return {beyond_mantle, outward};
}

namespace {

// The half plane through the axis of a cone in which x lies: distance from the axis and height.
struct Meridian {
  Vec3 outward;  // unit vector from the axis to x
  Vec3 axis;
  Eigen::Vector2d place;  // m

  Meridian(const Cone& cone, const Vec3& x) : axis(cone.axis) {
    const Vec3 offset = x - cone.start;
    const double height = offset.dot(axis);
    const Vec3 radial = offset - height * axis;
    const double radius = radial.norm();
    outward = radius > 0 ? Vec3(radial / radius) : perpendicular(axis);
    place = {radius, height};
  }
  Vec3 in_space(const Eigen::Vector2d& v) const { return v[0] * outward + v[1] * axis; }
};

struct Side {
  Eigen::Vector2d from, to;
  Eigen::Vector2d normal;  // out of the solid
};

// Both ends and the mantle.
std::array<Side, 3> sides(const Cone& cone) {
  const Eigen::Vector2d first(cone.start_radius, 0), last(cone.end_radius, cone.length);
  const Eigen::Vector2d slope = (last - first).normalized();
  return {{{{0, 0}, first, {0, -1}},
           {first, last, {slope[1], -slope[0]}},
           {last, {0, cone.length}, {0, 1}}}};
}

}  // namespace

DistanceSample measure(const Cone& cone, const Vec3& x) {
  const Meridian meridian(cone, x);
  double square = std::numeric_limits<double>::infinity(), highest = -square;
  Eigen::Vector2d offset(0, 0), normal(0, 0);
  for (const Side& side : sides(cone)) {
    const Eigen::Vector2d along = side.to - side.from, at = meridian.place - side.from;
    highest = std::max(highest, at.dot(side.normal));  // > 0: outside of this side
    if (along.squaredNorm() == 0.0) continue;
    const double share = std::clamp(at.dot(along) / along.squaredNorm(), 0.0, 1.0);
    const Eigen::Vector2d away = at - share * along;
    if (away.squaredNorm() >= square) continue;
    square = away.squaredNorm();
    offset = away;
    normal = side.normal;
  }
  const double sign = highest > 0 ? 1.0 : -1.0, distance = std::sqrt(square);
  const Eigen::Vector2d gradient =
      distance > 0 ? Eigen::Vector2d(sign / distance * offset) : normal;
  return {sign * distance, meridian.in_space(gradient)};
}

void add_near_surfaces(const Cone& cone, const Vec3& x, double reach, NearSurfaces& found) {
  const DistanceSample nearest = measure(cone, x);
  if (nearest.distance >= 0) {
    if (nearest.distance < reach) found.add(nearest);
    return;
  }
  const Meridian meridian(cone, x);
  for (const Side& side : sides(cone)) {
    const Eigen::Vector2d along = side.to - side.from, at = meridian.place - side.from;
    const double share = at.dot(along), phi = at.dot(side.normal);
    if (share >= 0 && share <= along.squaredNorm() && phi > -reach && along.squaredNorm() > 0)
      found.add({phi, meridian.in_space(side.normal)});
  }
}

DistanceSample measure(const Torus& torus, const Vec3& x) {
  const Vec3 offset = x - torus.center;
  const double height = offset.dot(torus.axis);
  const Vec3 radial = offset - height * torus.axis;
  const double radius = radial.norm();
  const Vec3 outward = radius > 0 ? Vec3(radial / radius) : perpendicular(torus.axis);
  const Vec3 from_line = (radius - torus.radius) * outward + height * torus.axis;
  const double distance = from_line.norm();
  return {distance - torus.tube_radius, distance > 0 ? Vec3(from_line / distance) : torus.axis};
}

DistanceSample measure(const Sphere& sphere, const Vec3& x) {
  const Vec3 offset = x - sphere.center;
  const double radius = offset.norm();
  return {radius - sphere.radius, radius > 0 ? Vec3(offset / radius) : Vec3(Vec3::UnitZ())};
}

void add_near_surfaces(const Box& box, const Vec3& x, double reach, NearSurfaces& found) {
  const Vec3 local = box.axes.transpose() * (x - box.center);
  const Vec3 excess = local.cwiseAbs() - box.half_size;
  if (excess.maxCoeff() >= 0) {
    const DistanceSample nearest = measure(box, x);
    if (nearest.distance < reach) found.add(nearest);
    return;
  }
  for (int d = 0; d < 3; ++d) {
    for (const double side : {-1.0, 1.0}) {
      const double phi = side * local[d] - box.half_size[d];
      if (phi > -reach) found.add({phi, side * box.axes.col(d)});
    }
  }
}

void add_near_surfaces(const Cylinder& cylinder, const Vec3& x, double reach, NearSurfaces& found) {
  const DistanceSample nearest = measure(cylinder, x);
  if (nearest.distance >= 0 || !std::isfinite(cylinder.half_length)) {
    if (std::abs(nearest.distance) < reach) found.add(nearest);
    return;
  }
  const double height = (x - cylinder.center).dot(cylinder.axis);
  for (const double side : {-1.0, 1.0}) {
    const double phi = side * height - cylinder.half_length;
    if (phi > -reach) found.add({phi, side * cylinder.axis});
  }
  Cylinder endless = cylinder;
  endless.half_length = std::numeric_limits<double>::infinity();
  const DistanceSample mantle = measure(endless, x);
  if (mantle.distance > -reach) found.add(mantle);
}

namespace {

// A solid with concave edges seen from inside.
template <class Solid>
class FacedShape final : public MeasuredShape<Solid> {
 public:
  using MeasuredShape<Solid>::MeasuredShape;
  bool has_several_contacts() const override { return true; }
  void add_near_surfaces(const Vec3& x, double reach, NearSurfaces& found) const override {
    gasgrain::add_near_surfaces(this->solid_, x, reach, found);
  }
};

}  // namespace

Shape make_shape(const Plane& plane) {
  return std::make_shared<MeasuredShape<Plane>>(plane);
}
Shape make_shape(const Box& box) {
  return std::make_shared<FacedShape<Box>>(box);
}
Shape make_shape(const Cylinder& cylinder) {
  if (!std::isfinite(cylinder.half_length))
    return std::make_shared<MeasuredShape<Cylinder>>(cylinder);
  return std::make_shared<FacedShape<Cylinder>>(cylinder);
}
Shape make_shape(const Cone& cone) {
  return std::make_shared<FacedShape<Cone>>(cone);
}
Shape make_shape(const Torus& torus) {
  return std::make_shared<MeasuredShape<Torus>>(torus);
}
Shape make_shape(const Sphere& sphere) {
  return std::make_shared<MeasuredShape<Sphere>>(sphere);
}

}  // namespace gasgrain
