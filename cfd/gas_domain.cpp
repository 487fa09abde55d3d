#include "cfd/gas_domain.hpp"

#include <algorithm>

#include "cfd/halo_exchange.hpp"
#include "cfd/moving_walls.hpp"
#include "coupling/shared/error.hpp"

namespace gasgrain::cfd {

namespace {

bool has_shear_or_flux(const SideConditions& sides, int d, int side) {
  return sides.has(d, side, BoundaryType::no_slip) || sides.has(d, side, BoundaryType::inlet) ||
         sides.has(d, side, BoundaryType::outlet);
}

// Share-weighted open volume of the cells on both sides of every owned face.
Field control_volumes(const GasDomain& domain, int d) {
  const WallGeometry& walls = domain.walls;
  Field volume(domain.size());
  for_each_face(domain.decomposition, d, [&](int i, int j, int k) {
    const std::ptrdiff_t n = volume.index(i, j, k), below = n - volume.stride(d);
    volume[n] = domain.cell_volume() * (walls.lower_share[d][n] * domain.joint_share[d][n] +
                                        walls.upper_share[d][below] * domain.joint_share[d][below]);
  });
  return volume;
}

// Lenders whose host is an owned cell or a first ghost, in the order of their local indices.
std::vector<Lender> lenders_of(const GasDomain& domain, int d) {
  std::vector<Lender> lenders;
  const Field& code = domain.walls.host[d];
  const Index3& size = domain.size();
  const IndexBox hosts{{-1, -1, -1}, {size[0] + 1, size[1] + 1, size[2] + 1}};
  for_each_in({{-halo, -halo, -halo}, {size[0] + halo, size[1] + halo, size[2] + halo}},
              [&](int i, int j, int k) {
                const int n = static_cast<int>(code(i, j, k)) - 1;
                if (n < 0) return;
                Index3 host{i, j, k};
                host[n / 2] += n % 2 == 0 ? -1 : 1;
                for (int e = 0; e < 3; ++e) {
                  if (host[e] < hosts.begin[e] || host[e] >= hosts.end[e]) return;
                }
                lenders.push_back({code.index(i, j, k), code.index(host[0], host[1], host[2])});
              });
  return lenders;
}

void check_volume_forcing(const GasCase& gas_case) {
  const std::string method = "numerics.immersed_boundary = \"volume-forcing\"";
  for (const Body& body : gas_case.bodies) {
    if (!body.acts_on_gas || body.motion.is_at_rest()) continue;
    throw UserError(method + " is only for bodies at rest, but body '" + body.name +
                    "' moves; use \"interpolation\"");
  }
  for (const auto& sides : gas_case.boundaries) {
    if (!sides[0].mean_velocity) continue;
    throw UserError(method +
                    " needs a given pressure_gradient where a mean_velocity of the flow is given; "
                    "state that or use \"interpolation\"");
  }
}

WallGeometry walls_of(const GasCase& gas_case, const Decomposition& decomposition,
                      const SideConditions& sides) {
  if (gas_case.numerics.immersed_boundary == BodyMethod::interpolation) {
    return make_wall_geometry(decomposition, sides, gas_case.bodies);
  }
  check_volume_forcing(gas_case);
  return make_spanned_wall_geometry(decomposition, sides, gas_case.bodies);
}

}  // namespace

GasDomain::GasDomain(const GasCase& gas_case, MPI_Comm communicator)
    : decomposition(communicator, gas_case.grid, periodic_directions(gas_case.boundaries),
                    gas_case.numerics.ranks),
      sides(gas_case.grid, gas_case.boundaries, gas_case.patches),
      bodies(gas_case.bodies),
      gas(gas_case.gas),
      walls(walls_of(gas_case, decomposition, sides)),
      density_scaling(gas_case.numerics.density_scaling),
      spacing(gas_case.grid.spacing()),
      open_share(size()) {
  derive();
  for (int d = 0; d < 3; ++d) {
    varies[d] = decomposition.grid().cells[d] > 1 || has_shear_or_flux(sides, d, 0) ||
                has_shear_or_flux(sides, d, 1);
  }
  std::vector<Body> resting;
  for (const Body& body : bodies) {
    if (body.motion.is_at_rest()) {
      resting.push_back(body);
    } else if (body.acts_on_gas) {
      has_motion = true;
    }
  }
  if (!has_motion) return;
  resting_open_area = make_wall_geometry(decomposition, sides, resting).open_area;
  swept = Field(size());
  set_swept_volume(swept, *this);
}

bool GasDomain::walls_move_until(double time) const {
  return std::any_of(bodies.begin(), bodies.end(), [&](const Body& body) {
    return body.acts_on_gas && body.motion.sweeps() && body.motion.moves_between(walls_time, time);
  });
}

void GasDomain::move_to(double time) {
  if (!has_motion) return;
  if (walls_move_until(time)) {
    walls = move_wall_geometry(decomposition, sides, bodies, time);
    derive();
  } else {
    set_wall_velocities(walls, decomposition, bodies, time);
  }
  walls_time = time;
  set_swept_volume(swept, *this);
}

void GasDomain::derive() {
  any_lenders = false;
  for (std::size_t n = 0; n < open_share.count(); ++n) open_share[n] = 1 - walls.wall_fraction[n];
  for (int d = 0; d < 3; ++d) {
    lenders[d] = lenders_of(*this, d);
    any_lenders = any_lenders || !lenders[d].empty();
    joint_share[d] = open_share;
    for (const Lender& lender : lenders[d]) joint_share[d][lender.host] += open_share[lender.cell];
  }
  any_lenders = max_over_ranks(decomposition, any_lenders ? 1.0 : 0.0) > 0.0;
  for (int d = 0; d < 3; ++d) {
    control_volume[d] = control_volumes(*this, d);
    double sum = 0.0;
    for_each_face(decomposition, d,
                  [&](int i, int j, int k) { sum += control_volume[d](i, j, k); });
    fill_ghosts(decomposition, control_volume[d]);
    solved[d] = sum_over_ranks(decomposition, sum) > 0.0;
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
