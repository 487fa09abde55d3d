// What the solid bodies leave open for the gas: cell and face fractions and distances.
#pragma once

#include <vector>

#include "cfd/field.hpp"
#include "cfd/grid.hpp"
#include "cfd/side_conditions.hpp"
#include "coupling/shared/body.hpp"

namespace gasgrain::cfd {

// All fields have their ghosts filled. Outside non-periodic sides of the grid everything counts as
// solid: wall_fraction = 1 in ghost cells, except that the faces of inlet and outlet sides are
// open.
struct WallGeometry {
  bool has_bodies = false;  // false: nothing but the sides of the grid
  // Bodies that volume forcing imposes: inside the grid a = 1 and all faces take part, in bodies
  // too.
  bool spans_bodies = false;
  Field wall_fraction;    // alpha, cells: share of the cell's volume inside a body, in [0, 1]
  VectorField open_area;  // a, faces: open share of the face's area, in [0, 1]; 0 on closed faces
  VectorField distance;   // phi at face centres, m; > 0 in the gas; the grid's diagonal instead
                          // further than two cells from bodies
  std::array<VectorField, 3> normal;  // grad phi at the face centres of direction [d]
  VectorField
      wall_velocity;  // m/s, component d of the nearest body's surface velocity at faces of d
  VectorField nearest_body;  // faces: index in the list of bodies, -1 far from them

  // Faces, only when spans_bodies: share of bodies in the volume of the face, half a cell to either
  // side, in [0, 1].
  VectorField solid_share;

  // Faces: 1 where gas moves freely (open, centre not inside a body, flux not prescribed), else 0.
  VectorField takes_part;

  // Cell centre: how the cell's grains share the two faces of direction d. A face takes part when
  // gas can move through it freely: open and without prescribed flux. Lower and upper share are
  // 1/2 each, or 0 and 1 when one face does not take part, or 0 and 0 when neither does.
  std::array<Field, 3> lower_share;
  std::array<Field, 3> upper_share;

  // Cell centre: an open cell none of whose faces of direction d takes part (a cut cell whose face
  // centres lie inside a body) lends its open volume and its grains, as far as direction d goes, to
  // a neighbour across an open face. 1 + 2 e + s: the neighbour on side s of direction e; 0: none.
  std::array<Field, 3> host;
};

// Local index offset from a cell to the host that `code` (a value of WallGeometry::host) names.
inline std::ptrdiff_t host_offset(const Field& field, double code) {
  const int n = static_cast<int>(code) - 1;
  return n % 2 == 0 ? -field.stride(n / 2) : field.stride(n / 2);
}

// Samples the bodies that act on the gas where they are at `time` [s]. A cell through whose faces
// no gas can move counts as solid, and so does a group of connected cells that are all cut: no cell
// of it resolves the gas. Throws UserError when a body that never moves does not reach into the
// grid (it acts on the gas and is nowhere solid in it) or leaves no open cell.
WallGeometry make_wall_geometry(const Decomposition& decomposition, const SideConditions& sides,
                                const std::vector<Body>& bodies, double time = 0.0);

// The same for volume forcing, of bodies that never move: the gas continues inside them. On the
// sides of the grid they close faces as above.
WallGeometry make_spanned_wall_geometry(const Decomposition& decomposition,
                                        const SideConditions& sides,
                                        const std::vector<Body>& bodies);

// The same for bodies that were checked before and have moved.
WallGeometry move_wall_geometry(const Decomposition& decomposition, const SideConditions& sides,
                                const std::vector<Body>& bodies, double time);

// Sets the surface velocities anew for bodies that stay where they are.
void set_wall_velocities(WallGeometry& walls, const Decomposition& decomposition,
                         const std::vector<Body>& bodies, double time);

}  // namespace gasgrain::cfd
