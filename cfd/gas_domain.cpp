#include "cfd/gas_domain.hpp"

#include "cfd/halo_exchange.hpp"

namespace gasgrain::cfd {

namespace {

bool has_shear_or_flux(const Boundary& side) {
  return side.type != BoundaryType::slip && side.type != BoundaryType::periodic;
}

// Share-weighted open volume of the cells on both sides of every owned face.
Field control_volumes(const GasDomain& domain, int d) {
  const WallGeometry& walls = domain.walls;
  Field volume(domain.size());
  for_each_face(domain.decomposition, d, [&](int i, int j, int k) {
    const std::ptrdiff_t n = volume.index(i, j, k), below = n - volume.stride(d);
    volume[n] = domain.cell_volume() * (walls.lower_share[d][n] * domain.open_share[n] +
                                        walls.upper_share[d][below] * domain.open_share[below]);
  });
  return volume;
}

}  // namespace

GasDomain::GasDomain(const GasCase& gas_case, MPI_Comm communicator)
    : decomposition(communicator, gas_case.grid, periodic_directions(gas_case.boundaries),
                    gas_case.numerics.ranks),
      boundaries(gas_case.boundaries),
      gas(gas_case.gas),
      walls(make_wall_geometry(decomposition, boundaries, gas_case.bodies)),
      spacing(gas_case.grid.spacing()),
      open_share(size()) {
  for (std::size_t n = 0; n < open_share.count(); ++n) open_share[n] = 1 - walls.wall_fraction[n];
  for (int d = 0; d < 3; ++d) {
    control_volume[d] = control_volumes(*this, d);
    double sum = 0.0;
    for_each_face(decomposition, d,
                  [&](int i, int j, int k) { sum += control_volume[d](i, j, k); });
    fill_ghosts(decomposition, control_volume[d]);
    solved[d] = sum_over_ranks(decomposition, sum) > 0.0;
    varies[d] = decomposition.grid().cells[d] > 1 || has_shear_or_flux(boundaries[d][0]) ||
                has_shear_or_flux(boundaries[d][1]);
  }
}

IndexBox inner_faces(const GasDomain& domain, int direction) {
  IndexBox box{{0, 0, 0}, domain.size()};
  if (domain.decomposition.at_boundary(direction, 0)) box.begin[direction] = 1;
  return box;
}

IndexBox plane_of(const GasDomain& domain, int direction, int index) {
  IndexBox box{{0, 0, 0}, domain.size()};
  box.begin[direction] = index;
  box.end[direction] = index + 1;
  return box;
}

}  // namespace gasgrain::cfd
