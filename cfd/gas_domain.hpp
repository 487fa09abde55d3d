// What stays the same from step to step: the block, the sides, the gas and the walls.
#pragma once

#include <array>
#include <vector>

#include "cfd/boundary.hpp"
#include "cfd/field.hpp"
#include "cfd/gas_case.hpp"
#include "cfd/grid.hpp"
#include "cfd/loops.hpp"
#include "cfd/side_conditions.hpp"
#include "cfd/wall_geometry.hpp"

namespace gasgrain::cfd {

// A cell that lends its gas and grains to another one, as local indices: see WallGeometry::host.
struct Lender {
  std::ptrdiff_t cell, host;
};

struct GasDomain {
  GasDomain(const GasCase& gas_case, MPI_Comm communicator);  // UserError: of its members

  // Moves the bodies to where they are at `time` [s]. Collective.
  void move_to(double time);
  // The shape of some body has another place at `time` than now.
  bool walls_move_until(double time) const;

  Decomposition decomposition;
  SideConditions sides;
  std::vector<Body> bodies;
  GasProperties gas;
  WallGeometry walls;
  double walls_time = 0.0;        // s: the bodies stand where they are then
  bool has_motion = false;        // some body that acts on the gas moves at some time
  double density_scaling;         // gamma of volume forcing
  VectorField resting_open_area;  // with motion: a of the resting bodies alone
  Field swept;                    // with motion: see set_swept_volume(), m^3/s
  Vec3 spacing;                   // m
  std::array<bool, 3> solved;     // component d has a face that takes part, on some rank
  std::array<bool, 3> varies;     // something can change along direction d
  VectorField control_volume;     // of faces, m^3: sum of the shares of its cells, 0 where fixed
  Field open_share;               // cells: 1 - alpha
  std::array<std::vector<Lender>, 3> lenders;  // with hosts among owned cells and first ghosts
  bool any_lenders = false;                    // on some rank
  VectorField joint_share;                     // cells: 1 - alpha with that of their lenders

  // Whatever follows from `walls`.
  void derive();

  const Index3& size() const { return decomposition.block().size; }
  // Position of the centre of a cell, or of a face of direction d, at local indices, m.
  Vec3 cell_centre(int i, int j, int k) const {
    const Index3& first = decomposition.block().lower;
    const Vec3 steps(i + first[0] + 0.5, j + first[1] + 0.5, k + first[2] + 0.5);
    return decomposition.grid().lower + steps.cwiseProduct(spacing);
  }
  Vec3 face_centre(int d, int i, int j, int k) const {
    return cell_centre(i, j, k) - 0.5 * spacing[d] * Vec3::Unit(d);
  }
  double face_area(int d) const { return spacing.prod() / spacing[d]; }
  double cell_volume() const { return spacing.prod(); }

  // Local index of the face plane on a side of the grid.
  int side_plane(int direction, int side) const {
    const int cells = side == 0 ? 0 : decomposition.grid().cells[direction];
    return cells - decomposition.block().lower[direction];
  }
  // Local index of the layer of cells inside that side.
  int side_layer(int direction, int side) const { return side_plane(direction, side) - side; }
  // Global indices of an own or ghost cell.
  Index3 global_cell(int i, int j, int k) const {
    const Index3& first = decomposition.block().lower;
    return {i + first[0], j + first[1], k + first[2]};
  }
  // Condition of the face of a side next to a cell given by local indices.
  const SideCondition& condition(int direction, int side, const Index3& local) const {
    return sides.at(direction, side, global_cell(local[0], local[1], local[2]));
  }
  bool is_outlet(int direction, int side, const Index3& local) const {
    return condition(direction, side, local).type == BoundaryType::outlet;
  }
  bool is_periodic(int direction) const { return sides.is_periodic(direction); }
};

// Owned faces of a direction that are not on a side of the grid.
IndexBox inner_faces(const GasDomain& domain, int direction);
// Faces (or, with a layer of cells, cells) of this block in the plane `index` of a direction.
IndexBox plane_of(const GasDomain& domain, int direction, int index);

template <class Visit>
void for_each_in(const IndexBox& box, Visit&& visit) {
  for (int k = box.begin[2]; k < box.end[2]; ++k) {
    for (int j = box.begin[1]; j < box.end[1]; ++j) {
      for (int i = box.begin[0]; i < box.end[0]; ++i) visit(i, j, k);
    }
  }
}

// visit(storage index of the cell, of the face, condition) for every face that this block has on a
// side of the grid.
template <class Visit>
void for_each_side_face(const GasDomain& domain, int direction, int side, Visit&& visit) {
  if (!domain.decomposition.at_boundary(direction, side)) return;
  const Field& like = domain.open_share;
  const std::ptrdiff_t to_face = side == 1 ? like.stride(direction) : 0;
  for_each_in(
      plane_of(domain, direction, domain.side_layer(direction, side)), [&](int i, int j, int k) {
        const std::ptrdiff_t cell = like.index(i, j, k);
        visit(cell, cell + to_face, domain.sides.at(direction, side, domain.global_cell(i, j, k)));
      });
}

// The same for the faces that are outlets.
template <class Visit>
void for_each_outlet_face(const GasDomain& domain, int direction, int side, Visit&& visit) {
  if (!domain.sides.has(direction, side, BoundaryType::outlet)) return;
  for_each_side_face(domain, direction, side,
                     [&](std::ptrdiff_t cell, std::ptrdiff_t face, const SideCondition& condition) {
                       if (condition.type == BoundaryType::outlet) visit(cell, face, condition);
                     });
}

// All owned faces of a direction as a box.
inline IndexBox all_faces(const GasDomain& domain, int direction) {
  return {{0, 0, 0}, owned_faces(domain.decomposition, direction)};
}

}  // namespace gasgrain::cfd
