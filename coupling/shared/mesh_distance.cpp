#include "coupling/shared/mesh_distance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "coupling/shared/error.hpp"
#include "coupling/shared/known_distance.hpp"
#include "coupling/shared/measured_shape.hpp"
#include "coupling/shared/triangle_tree.hpp"

namespace gasgrain {

namespace {

using Tree = std::shared_ptr<const TriangleTree>;

// Inside of any of these, or near their surface.
struct MeshUnion {
  std::vector<Tree> solids;
};
struct Sheet {
  Tree surface;
  double half_thickness;
};

constexpr double everywhere = std::numeric_limits<double>::infinity();

bool is_inside(const TriangleTree& tree, const Vec3& x) {
  if ((x.array() < tree.lower().array()).any() || (x.array() > tree.upper().array()).any())
    return false;
  return tree.winding_number(x) > 0.5;
}

// Distance and gradient away from the surface; on it, the normal.
DistanceSample unsigned_sample(const TriangleTree::Nearest& nearest, const Vec3& x) {
  const double distance = std::sqrt(nearest.square_distance);
  if (distance == 0.0) return {0.0, nearest.normal};
  return {distance, (x - nearest.point) / distance};
}

// The nearest surface of all while outside of all; else the deepest, as in a union.
DistanceSample measure(const MeshUnion& mesh, const Vec3& x) {
  DistanceSample result{everywhere, Vec3::Zero()};
  for (const Tree& solid : mesh.solids) {
    const bool inside = is_inside(*solid, x);
    if (!inside && result.distance <= 0) continue;
    const double limit = inside ? everywhere : result.distance * result.distance;
    const TriangleTree::Nearest nearest = solid->nearest(x, limit);
    if (nearest.square_distance >= limit) continue;
    DistanceSample own = unsigned_sample(nearest, x);
    if (inside) own = {-own.distance, own.distance > 0 ? Vec3(-own.gradient) : own.gradient};
    if (own.distance < result.distance) result = own;
  }
  return result;
}

DistanceSample measure(const Sheet& sheet, const Vec3& x) {
  DistanceSample result = unsigned_sample(sheet.surface->nearest(x, everywhere), x);
  result.distance -= sheet.half_thickness;
  return result;
}

class MeshShape final : public MeasuredShape<MeshUnion>, public DistanceFromKnown {
 public:
  MeshShape(MeshUnion solid, std::string remarks)
      : MeasuredShape(std::move(solid)), remarks_(std::move(remarks)) {}
  // A place is on the same side of all surfaces as a known one from which none can be reached, and
  // the winding numbers, which cost most, need not be asked for.
  double distance_near(const Vec3& x, const KnownDistance& known) const override {
    const double way = (x - known.place).norm(), from = std::abs(known.distance);
    const bool within_parts = known.distance < 0 && solid_.solids.size() > 1;
    if (way >= from || within_parts) return distance(x);
    constexpr double rounding = 1 + 1e-9;
    double square = (from + way) * (from + way) * rounding;
    for (const Tree& solid : solid_.solids) square = solid->nearest(x, square).square_distance;
    return std::copysign(std::sqrt(square), known.distance);
  }
  std::string remarks() const override { return remarks_; }

 private:
  std::string remarks_;
};

}  // namespace

Shape make_mesh_shape(const RepairedMesh& mesh, std::string remarks) {
  GASGRAIN_ASSERT(!mesh.solids.empty());
  MeshUnion shape;
  for (const TriangleMesh& solid : mesh.solids)
    shape.solids.push_back(std::make_shared<const TriangleTree>(solid));
  return std::make_shared<MeshShape>(std::move(shape), std::move(remarks));
}

Shape make_sheet_shape(const std::vector<LooseTriangle>& triangles, double thickness) {
  GASGRAIN_ASSERT(thickness > 0);
  const bool has_area = std::any_of(triangles.begin(), triangles.end(), [](const auto& t) {
    return !(t[1] - t[0]).cross(t[2] - t[0]).isZero(0.0);
  });
  if (!has_area) throw UserError("no triangle has an area; export the surface again");
  return std::make_shared<MeasuredShape<Sheet>>(
      Sheet{std::make_shared<const TriangleTree>(triangles), 0.5 * thickness});
}

}  // namespace gasgrain
