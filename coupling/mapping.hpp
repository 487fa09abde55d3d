// The ways to spread a grain over cells: names, shares per cell, width.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "cfd/grid.hpp"
#include "coupling/shared/vec3.hpp"

namespace gasgrain::coupling {

enum class Mapping {
  spline,     // quadratic B-spline (TSC) on 27 cells; the default
  centroid,   // all in the cell that holds the centre
  trilinear,  // cloud in cell: linear weights of the eight nearest cells
  satellite,  // 29 points of equal volume in the grain, each to the cell that holds it
  exact,      // the volume of the sphere within each cell
};

// As in coupling.mapping; in the order of Mapping.
const std::vector<std::string>& mapping_names();
Mapping find_mapping(const std::string& name);  // precondition: one of mapping_names()
const std::string& mapping_name(Mapping mapping);

// Cells beside the one that holds the centre that a grain of that diameter [m] may reach, >= 1.
int mapping_reach(Mapping mapping, const cfd::Grid& grid, double diameter);

// Variance that the mapping adds to a point, per direction in units of the spacing squared, mean
// over all places of a grain of that diameter [m] in its cell.
Vec3 mapping_variance(Mapping mapping, const cfd::Grid& grid, double diameter);

// Quadratic B-spline weights at the cells -1, 0, 1 around the cell that holds the grain; `offset`
// in [-1/2, 1/2] is the distance from the cell centre over the spacing.
inline std::array<double, 3> spline_weights(double offset) {
  return {0.5 * (0.5 - offset) * (0.5 - offset), 0.75 - offset * offset,
          0.5 * (0.5 + offset) * (0.5 + offset)};
}

// A cell, relative to the one that holds the grain's centre, and its share of the grain.
struct CellShare {
  cfd::Index3 offset;
  double share;
};

// Replaces `shares` by those of a grain on a grid without walls; they add up to 1. `offset`:
// centre from the middle of its cell over the spacing, in [-1/2, 1/2]; `radius` over the spacing.
void share_among_cells(std::vector<CellShare>& shares, Mapping mapping, const Vec3& offset,
                       const Vec3& radius);

}  // namespace gasgrain::coupling
