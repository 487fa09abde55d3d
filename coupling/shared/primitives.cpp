// Signed distance of the primitive solids (eq 17), positive outside.
//
// Each distance is the exact Euclidean one on both sides of the surface: outside an edge or corner
// it is the distance to that edge or corner, inside it is the distance to the nearest face. The
// gradient is the derivative of that value and a unit vector everywhere.
#include "coupling/shared/primitives.hpp"

#include <cmath>

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

DistanceSample measure(const Sphere& sphere, const Vec3& x) {
  const Vec3 offset = x - sphere.center;
  const double radius = offset.norm();
  return {radius - sphere.radius, radius > 0 ? Vec3(offset / radius) : Vec3(Vec3::UnitZ())};
}

Shape make_shape(const Plane& plane) {
  return std::make_shared<MeasuredShape<Plane>>(plane);
}
Shape make_shape(const Box& box) {
  return std::make_shared<MeasuredShape<Box>>(box);
}
Shape make_shape(const Cylinder& cylinder) {
  return std::make_shared<MeasuredShape<Cylinder>>(cylinder);
}
Shape make_shape(const Sphere& sphere) {
  return std::make_shared<MeasuredShape<Sphere>>(sphere);
}

}  // namespace gasgrain
