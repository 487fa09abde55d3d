// Booleans of signed distances: union = min, intersection = max, complement = -phi.
//
// The value is that of the part that decides, and so is the gradient: it is the exact derivative of
// the value wherever that exists. Exact surface always; exact distance outside a union and inside
// an intersection; elsewhere |phi| is a lower bound (Quilez, "distance functions"): near a concave
// edge of the solid's outside the nearest surface of one part may lie within another.
#include "coupling/shared/boolean_shapes.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "coupling/shared/error.hpp"
#include "coupling/shared/known_distance.hpp"
#include "coupling/shared/measured_shape.hpp"
#include "coupling/shared/near_surfaces.hpp"

namespace gasgrain {

namespace {

struct Union {
  std::vector<Shape> parts;
};
struct Intersection {
  std::vector<Shape> parts;
};
struct Complement {
  Shape shape;
};

DistanceSample measure(const Union& solid, const Vec3& x) {
  DistanceSample result = solid.parts.front()->sample(x);
  for (std::size_t i = 1; i < solid.parts.size(); ++i) {
    const DistanceSample part = solid.parts[i]->sample(x);
    if (part.distance < result.distance) result = part;
  }
  return result;
}

DistanceSample measure(const Intersection& solid, const Vec3& x) {
  DistanceSample result = solid.parts.front()->sample(x);
  for (std::size_t i = 1; i < solid.parts.size(); ++i) {
    const DistanceSample part = solid.parts[i]->sample(x);
    if (part.distance > result.distance) result = part;
  }
  return result;
}

DistanceSample measure(const Complement& solid, const Vec3& x) {
  const DistanceSample inside = solid.shape->sample(x);
  return {-inside.distance, -inside.gradient};
}

double resolved_range(const std::vector<Shape>& parts) {
  double range = parts.front()->resolved_range();
  for (const Shape& part : parts) range = std::min(range, part->resolved_range());
  return range;
}
// Surfaces of the parts are those of the whole where their nearest point lies on it: neither
// covered by another part (union) nor cut away by it (intersection). The nearest one is always
// kept.
void add_surfaces_of_parts(const SignedDistance& whole, const std::vector<Shape>& parts,
                           const Vec3& x, double reach, NearWalls& found) {
  constexpr double tolerance = 1e-3;  // of the reach
  NearWalls all;
  for (const Shape& part : parts) add_near_walls(*part, x, reach, all);
  const int before = found.count;
  for (int n = 0; n < all.count; ++n) {
    const NearWall& own = all.surface[n];
    const double gradient = own.gradient.squaredNorm();
    if (gradient == 0.0) continue;
    const Vec3 foot = x - own.distance / gradient * own.gradient;
    if (std::abs(whole.distance(foot)) <= tolerance * reach) found.add(own);
  }
  if (found.count > before) return;
  const DistanceSample nearest = whole.sample(x);
  if (std::abs(nearest.distance) < reach) found.add(NearWall(nearest));
}

bool has_several_contacts(const std::vector<Shape>& parts) {
  return parts.size() > 1 || parts.front()->has_several_contacts();
}
bool has_several_contacts(const Union& solid) {
  return has_several_contacts(solid.parts);
}
bool has_several_contacts(const Intersection& solid) {
  return has_several_contacts(solid.parts);
}
bool has_several_contacts(const Complement& solid) {
  return solid.shape->has_several_contacts();
}

void add_walls_of(const SignedDistance& whole, const Union& solid, const Vec3& x, double reach,
                  NearWalls& found) {
  add_surfaces_of_parts(whole, solid.parts, x, reach, found);
}
void add_walls_of(const SignedDistance& whole, const Intersection& solid, const Vec3& x,
                  double reach, NearWalls& found) {
  add_surfaces_of_parts(whole, solid.parts, x, reach, found);
}
void add_walls_of(const SignedDistance&, const Complement& solid, const Vec3& x, double reach,
                  NearWalls& found) {
  const int before = found.count;
  add_near_walls(*solid.shape, x, reach, found);
  for (int n = before; n < found.count; ++n) {
    NearWall& wall = found.surface[n];
    wall.distance = -wall.distance;
    wall.gradient = -wall.gradient;
    if (wall.way > 0) wall.curvature = -wall.curvature;
  }
}

double steepest_gradient(const std::vector<Shape>& parts) {
  double steepest = 0.0;
  for (const Shape& part : parts) steepest = std::max(steepest, part->steepest_gradient());
  return steepest;
}
double steepest_gradient(const Union& solid) {
  return steepest_gradient(solid.parts);
}
double steepest_gradient(const Intersection& solid) {
  return steepest_gradient(solid.parts);
}
double steepest_gradient(const Complement& solid) {
  return solid.shape->steepest_gradient();
}

std::string remarks(const std::vector<Shape>& parts) {
  std::string lines;
  for (const Shape& part : parts) lines += part->remarks();
  return lines;
}
std::string remarks(const Union& solid) {
  return remarks(solid.parts);
}
std::string remarks(const Intersection& solid) {
  return remarks(solid.parts);
}
std::string remarks(const Complement& solid) {
  return solid.shape->remarks();
}

double resolved_range(const Union& solid) {
  return resolved_range(solid.parts);
}
double resolved_range(const Intersection& solid) {
  return resolved_range(solid.parts);
}
double resolved_range(const Complement& solid) {
  return solid.shape->resolved_range();
}

template <class Solid>
class BooleanShape : public MeasuredShape<Solid>, public CurvedDistance {
 public:
  using MeasuredShape<Solid>::MeasuredShape;
  double resolved_range() const override { return gasgrain::resolved_range(this->solid_); }
  double steepest_gradient() const override { return gasgrain::steepest_gradient(this->solid_); }
  bool has_several_contacts() const override {
    return gasgrain::has_several_contacts(this->solid_);
  }
  void add_near_surfaces(const Vec3& x, double reach, NearSurfaces& found) const override {
    add_without_curvature(*this, x, reach, found);
  }
  void add_near_walls(const Vec3& x, double reach, NearWalls& found) const override {
    add_walls_of(*this, this->solid_, x, reach, found);
  }
  std::string remarks() const override { return gasgrain::remarks(this->solid_); }
};

class ComplementShape final : public BooleanShape<Complement>, public DistanceFromKnown {
 public:
  using BooleanShape::BooleanShape;
  double distance_near(const Vec3& x, const KnownDistance& known) const override {
    return -gasgrain::distance_near(*solid_.shape, x, {known.place, -known.distance});
  }
};

}  // namespace

Shape make_union(std::vector<Shape> parts) {
  GASGRAIN_ASSERT(!parts.empty());
  return std::make_shared<BooleanShape<Union>>(Union{std::move(parts)});
}

Shape make_intersection(std::vector<Shape> parts) {
  GASGRAIN_ASSERT(!parts.empty());
  return std::make_shared<BooleanShape<Intersection>>(Intersection{std::move(parts)});
}

Shape make_difference(Shape base, Shape removed) {
  return make_intersection({std::move(base), make_complement(std::move(removed))});
}

Shape make_complement(Shape shape) {
  return std::make_shared<ComplementShape>(Complement{std::move(shape)});
}

}  // namespace gasgrain
