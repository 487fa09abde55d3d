// Void fraction where shear stresses sit: on the edges of the cells.
#pragma once

#include "cfd/gas_domain.hpp"

namespace gasgrain::cfd {

// An edge's void fraction is sum(gas) / sum(share) over the four cells around it; the edges along d
// are counted with the cell above them in the other two directions.
struct EdgeVoidFraction {
  Field share;  // 1 - alpha; outside a side of the grid that of the cell inside, in its corners 0
  VectorField per_share;  // [d]: 1 / sum(share) of the edges along d, 0 inside solid
  Field gas;  // share * eps; outside such that the mean with the cell inside is eps on the side
};

// With gas = share: no grains.
EdgeVoidFraction make_edge_void_fraction(const GasDomain& domain);

// `cells`: eps with its ghosts filled.
void update(EdgeVoidFraction& edges, const GasDomain& domain, const Field& cells);

// eps on a side of the grid from the cell at it (`first`) and the one behind (`second`), both in
// (0, 1]; the result is in the same range.
double void_fraction_on_side(double first, double second);

}  // namespace gasgrain::cfd
