// Shares of a grain in the cells around it for every mapping.
//
//   spline     b(x) = quadratic B-spline per direction
//   trilinear  1 - |x| per direction
//   satellite  centre and two shells of 14 points (6 on the axes, 8 on the space diagonals) at
//              0.62761 and 0.92853 of the radius, 1/29 each: the middles of shells of 14/29 of the
//              volume beyond a core of 1/29
//   exact      overlap of sphere and cell
//
// Mean variances: that of the grain itself (R^2/5 for a sphere and its points), that of a point
// counted at the middle of its cell (1/12 of the spacing squared) and, for trilinear, of the cube
// that the weights are the overlaps of (1/12 more). The B-spline has 1/4 wherever the grain is.
// Sources: Hockney & Eastwood (1988), section 5-3 (spline, cloud in cell); Goniva et al.,
// Particuology 10 (2012) 582, and CFDEMcoupling's 'divided' void fraction (points).
#include "coupling/mapping.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "coupling/shared/error.hpp"
#include "coupling/sphere_overlap.hpp"

namespace gasgrain::coupling {

namespace {

constexpr double variance_of_sphere = 1.0 / 5.0;  // in radius^2
constexpr double variance_of_cell = 1.0 / 12.0;   // in spacing^2

bool depends_on_size(Mapping mapping) {
  return mapping == Mapping::satellite || mapping == Mapping::exact;
}

Vec3 radius_in_cells(const cfd::Grid& grid, double diameter) {
  return 0.5 * diameter * grid.spacing().cwiseInverse();
}

std::array<double, 3> linear_weights(double offset) {
  return {std::max(0.0, -offset), 1 - std::abs(offset), std::max(0.0, offset)};
}

using Weights = std::array<std::array<double, 3>, 3>;  // [direction][-1, 0, 1]

void share_by_weights(std::vector<CellShare>& shares, const Weights& weights) {
  for (int c = -1; c <= 1; ++c)
    for (int b = -1; b <= 1; ++b)
      for (int a = -1; a <= 1; ++a) {
        const double share = weights[0][a + 1] * weights[1][b + 1] * weights[2][c + 1];
        if (share > 0) shares.push_back({{a, b, c}, share});
      }
}

// Points of the unit sphere.
std::vector<Vec3> satellites() {
  std::vector<Vec3> points{Vec3::Zero()};
  for (const double shell : {0.62761, 0.92853}) {
    for (const double side : {-shell, shell}) {
      for (int d = 0; d < 3; ++d) points.emplace_back(side * Vec3::Unit(d));
      for (int n = 0; n < 4; ++n)
        points.emplace_back(side / std::sqrt(3.0) *
                            Vec3(1, n % 2 == 0 ? 1 : -1, n / 2 == 0 ? 1 : -1));
    }
  }
  return points;
}

void share_by_points(std::vector<CellShare>& shares, const Vec3& offset, const Vec3& radius) {
  static const std::vector<Vec3> points = satellites();
  for (const Vec3& point : points) {
    cfd::Index3 cell;
    for (int d = 0; d < 3; ++d)
      cell[d] = static_cast<int>(std::floor(offset[d] + radius[d] * point[d] + 0.5));
    const auto known = std::find_if(shares.begin(), shares.end(),
                                    [&](const CellShare& s) { return s.offset == cell; });
    if (known == shares.end()) {
      shares.push_back({cell, 1.0 / points.size()});
    } else {
      known->share += 1.0 / points.size();
    }
  }
}

void share_by_overlap(std::vector<CellShare>& shares, const Vec3& offset, const Vec3& radius) {
  cfd::Index3 first, count;
  std::array<std::vector<double>, 3> planes;
  for (int d = 0; d < 3; ++d) {
    first[d] = static_cast<int>(std::floor(offset[d] - radius[d] + 0.5));
    const int last = static_cast<int>(std::floor(offset[d] + radius[d] + 0.5));
    count[d] = last - first[d] + 1;
    for (int n = first[d]; n <= last + 1; ++n)
      planes[d].push_back((n - 0.5 - offset[d]) / radius[d]);
  }
  std::vector<double> volumes;
  sphere_shares(volumes, {planes[0], planes[1], planes[2]});
  std::size_t next = 0;
  for (int k = 0; k < count[2]; ++k)
    for (int j = 0; j < count[1]; ++j)
      for (int i = 0; i < count[0]; ++i) {
        const double share = volumes[next++];
        if (share != 0) shares.push_back({{first[0] + i, first[1] + j, first[2] + k}, share});
      }
}

}  // namespace

const std::vector<std::string>& mapping_names() {
  static const std::vector<std::string> names{"spline", "centroid", "trilinear", "satellite",
                                              "exact"};
  return names;
}

Mapping find_mapping(const std::string& name) {
  const auto& names = mapping_names();
  const auto found = std::find(names.begin(), names.end(), name);
  GASGRAIN_ASSERT(found != names.end());
  return static_cast<Mapping>(found - names.begin());
}

const std::string& mapping_name(Mapping mapping) {
  return mapping_names()[static_cast<std::size_t>(mapping)];
}

int mapping_reach(Mapping mapping, const cfd::Grid& grid, double diameter) {
  if (!depends_on_size(mapping)) return 1;
  // one more than whole cells in the radius: the centre may lie on the rim of its cell
  return 1 + static_cast<int>(std::floor(radius_in_cells(grid, diameter).maxCoeff()));
}

Vec3 mapping_variance(Mapping mapping, const cfd::Grid& grid, double diameter) {
  if (mapping == Mapping::spline) return Vec3::Constant(3 * variance_of_cell);
  if (mapping == Mapping::trilinear) return Vec3::Constant(2 * variance_of_cell);
  Vec3 variance = Vec3::Constant(variance_of_cell);
  if (depends_on_size(mapping))
    variance += variance_of_sphere * radius_in_cells(grid, diameter).cwiseAbs2();
  return variance;
}

void share_among_cells(std::vector<CellShare>& shares, Mapping mapping, const Vec3& offset,
                       const Vec3& radius) {
  shares.clear();
  Weights weights;
  switch (mapping) {
    case Mapping::centroid:
      shares.push_back({{0, 0, 0}, 1.0});
      return;
    case Mapping::satellite:
      return share_by_points(shares, offset, radius);
    case Mapping::exact:
      return share_by_overlap(shares, offset, radius);
    case Mapping::spline:
      for (int d = 0; d < 3; ++d) weights[d] = spline_weights(offset[d]);
      break;
    case Mapping::trilinear:
      for (int d = 0; d < 3; ++d) weights[d] = linear_weights(offset[d]);
      break;
  }
  share_by_weights(shares, weights);
}

}  // namespace gasgrain::coupling
