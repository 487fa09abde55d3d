// A grain holds the force F of an exchange for the interval T', the gas gave it for T. What it
// received beyond, F (T' - T), has to go back: a force S = D F (T' - T)/T' per volume against the
// mixture, over T'. Taken from the gas alone it would come back to the grains: gas between grains
// cannot be accelerated, grad p = -S/eps takes its place, and a bed that the gas carries is pushed
// by (1 - eps) g (T' - T), a twentieth of the slip velocity where T is half of the exchange limit
// and T' = 7/8 T. Where the interval depends on the motion that follows, a push leads to the next.
//
// So gas and grains share in S as they share in grad p,
//
//   gas: eps S = S - (1 - eps) H     grains: V H     H = S,
//
// and in a packing grad p = -S leaves both as they were: the sides of the grid give the impulse, as
// they gave it to begin with. Where the gas is free to move, eps -> 1 and it gives nearly all.
// Light grains feel grad p with a lag (cfd/felt_gradient.cpp), H follows S likewise,
//
//   H = H_before + theta (S - H_before),      theta = 1/(1 + m (1 - eps)),
//
// and the gas gives what is left, S - (1 - eps) H. Any H keeps the momentum. Where a direction has
// no free face there is no grad p either: H = 0.
//
// Assumes that S and eps change little from cell to cell. Between cells the gas has means of both,
// so that at the surface of a packing some of S is left over, whose sum is about zero.
#include "coupling/owed_impulse.hpp"

#include <string>

#include "cfd/loops.hpp"

namespace gasgrain::coupling {

void OwedImpulse::split(cfd::VectorField& force, const cfd::Field& void_fraction,
                        const cfd::WallGeometry& walls, double lag) {
  if (is_empty() || lag == 0.0) felt_.fill(cfd::Field(void_fraction.size()));
  cfd::for_each_cell(void_fraction.size(), [&](int i, int j, int k) {
    const std::ptrdiff_t n = void_fraction.index(i, j, k);
    const double solids = 1.0 - void_fraction[n], theta = 1.0 / (1.0 + lag * solids);
    for (int d = 0; d < 3; ++d) {
      const bool is_free = walls.lower_share[d][n] + walls.upper_share[d][n] + walls.host[d][n] > 0;
      double& felt = felt_[d][n];
      felt = is_free ? felt + theta * (force[d][n] - felt) : 0.0;
      force[d][n] -= solids * felt;
    }
  });
}

void OwedImpulse::visit_state(cfd::StateArchive& archive, const cfd::Index3& size) {
  bool is_there = !is_empty();
  archive.number_of("owed_impulse", is_there);
  if (archive.restores()) felt_.fill(is_there ? cfd::Field(size) : cfd::Field());
  if (!is_there) return;
  for (int d = 0; d < 3; ++d) archive.cells(std::string("owed_impulse_") + "xyz"[d], felt_[d]);
}

}  // namespace gasgrain::coupling
