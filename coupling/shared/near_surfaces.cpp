// Several contacts of one ball: the list that the shape gives, without those beyond the ball's
// radius and without doubles; and how a sampled field finds them.
//
// A ball that touches two walls has its centre where both are equally near: there phi has a kink
// (|grad phi| < 1), and its samples on either side belong to one wall each. So near a kink the
// field is looked at a little way off in six directions. Each sample (phi, n) there stands for the
// plane through its foot; the foot below x on that plane is corrected by the field twice. Where
// |grad phi| = 1 there is no kink within reach of the interpolation and the sample at x is all.
#include "coupling/shared/near_surfaces.hpp"

#include <cmath>
#include <utility>

#include "coupling/shared/sampled_distance.hpp"

namespace gasgrain {

namespace {

constexpr double kink = 0.998;      // |grad phi| below: a kink is near
constexpr double clean = 0.98;      // |grad phi| above: belongs to one wall
constexpr double look_aside = 2.0;  // spacings
constexpr int corrections = 2;
constexpr double surface_error = 0.5;  // spacings by which a foot may miss the surface
constexpr double aside = 0.05;  // part of the reach by which x may miss the normal through the foot

// Replaces one with the same normal if nearer, else adds.
void add_distinct(const DistanceSample& sample, int from, NearSurfaces& found) {
  for (int n = from; n < found.count; ++n) {
    DistanceSample& other = found.surface[n];
    const double lengths = other.gradient.norm() * sample.gradient.norm();
    if (other.gradient.dot(sample.gradient) < same_normal * lengths) continue;
    if (std::abs(sample.distance) < std::abs(other.distance)) other = sample;
    return;
  }
  found.add(sample);
}

}  // namespace

NearSurfaces ball_contacts(const SignedDistance& shape, const DistanceSample& nearest,
                           const Vec3& x, double radius) {
  NearSurfaces result;
  if (nearest.distance <= 0) {
    result.add(nearest);
    return result;
  }
  NearSurfaces all;
  shape.add_near_surfaces(x, radius, all);
  for (int n = 0; n < all.count; ++n)
    if (all.surface[n].distance > 0 && all.surface[n].distance < radius)
      add_distinct(all.surface[n], 0, result);
  for (int n = 1; n < result.count; ++n)
    if (result.surface[n].distance < result.surface[0].distance)
      std::swap(result.surface[n], result.surface[0]);
  return result;
}

void SampledDistance::add_near_surfaces(const Vec3& x, double reach, NearSurfaces& found) const {
  const DistanceSample nearest = sample(x);
  if (std::abs(nearest.distance) >= reach + data_.spacing) return;
  bool resolved = false;
  if (nearest.gradient.squaredNorm() < kink * kink || kink_between_cells(x, nearest)) {
    for (int d = 0; d < 3; ++d) {
      for (const double side : {-look_aside, look_aside}) {
        const Vec3 at = x + side * data_.spacing * Vec3::Unit(d);
        const DistanceSample there = sample(at);
        if (there.gradient.norm() > clean)
          resolved = add_plane_through(there, at, x, reach, found) || resolved;
      }
    }
  }
  if (!resolved && std::abs(nearest.distance) < reach) found.add(nearest);
}

// A kink that lies along the sides of cells shows in no cell of the linear interpolation.
bool SampledDistance::kink_between_cells(const Vec3& x, const DistanceSample& nearest) const {
  if (data_.interpolation != Interpolation::linear) return false;
  constexpr double near = 0.25;  // spacings
  for (int d = 0; d < 3; ++d)
    for (const double side : {-near, near})
      if (sample(x + side * data_.spacing * Vec3::Unit(d)).gradient.dot(nearest.gradient) <
          same_normal * nearest.gradient.squaredNorm())
        return true;
  return false;
}

// `there`: the field at `at`, which belongs to one wall. Whether that wall faces x.
bool SampledDistance::add_plane_through(const DistanceSample& there, const Vec3& at, const Vec3& x,
                                        double reach, NearSurfaces& found) const {
  Vec3 n = there.gradient.normalized();
  Vec3 foot = at - there.distance * n;
  for (int k = 0; k < corrections; ++k) {
    foot = x - (x - foot).dot(n) * n;
    const DistanceSample on_surface = sample(foot);
    if (std::abs(on_surface.distance) > surface_error * data_.spacing ||
        on_surface.gradient.norm() < clean)
      return false;
    n = on_surface.gradient.normalized();
    foot -= on_surface.distance * n;
  }
  const double distance = (x - foot).dot(n);
  if ((x - foot - distance * n).norm() > aside * reach) return false;
  if (std::abs(distance) < reach) add_distinct({distance, n}, 0, found);
  return true;
}

}  // namespace gasgrain
