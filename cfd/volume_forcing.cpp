// With alpha_f the share of bodies at rest in the volume of a face (half a cell to either side),
//
//   u* <- (1 - alpha_f) u* + alpha_f u_wall,     c = eps dt / (rho (s + K)),
//   s = 1 + (gamma - 1) alpha_f
//
// eq 21 to 23 of Mori, Wu, Sakai 2019: velocity of the bodies by volume fractions, and a density
// gamma times that of the gas inside them, so that the pressure equation spans the bodies and its
// gradient moves little gas there. First order, with a wall position that depends on the step,
// because the share alpha_f is taken away per step and not per time; and a body inside a bed leaks,
// the more the longer the step, because drag lowers the c of the gas around it towards c/gamma.
//
// Momentum: V the control volume of a face as the budget has it, the forcing adds
// V eps rho (1 + K) times the change of u*, and the scaling V eps dt (1 - (1 + K)/(s + K)) grad p,
// the part of the pressure that the correction leaves out.
#include "cfd/volume_forcing.hpp"

namespace gasgrain::cfd {

VolumeForcing::VolumeForcing(const GasDomain& domain) {
  const WallGeometry& walls = domain.walls;
  if (!walls.spans_bodies) return;
  for (int d = 0; d < 3; ++d) {
    for_each_face(domain.decomposition, d, [&](int i, int j, int k) {
      const std::ptrdiff_t n = walls.solid_share[d].index(i, j, k);
      if (walls.takes_part[d][n] == 0.0 || walls.solid_share[d][n] == 0.0) return;
      faces_[d].push_back({.face = n,
                           .solid_share = walls.solid_share[d][n],
                           .body = static_cast<int>(walls.nearest_body[d][n]),
                           .position = domain.face_centre(d, i, j, k),
                           .impulse = 0.0});
    });
  }
}

Vec3 VolumeForcing::apply(VectorField& velocity, const GasDomain& domain, const FaceMedium& medium,
                          double dt) {
  Vec3 impulse = Vec3::Zero();
  const double rho = domain.gas.density;
  for (int d = 0; d < 3; ++d) {
    for (Face& face : faces_[d]) {
      double& u = velocity[d][face.face];
      const double wall = domain.walls.wall_velocity[d][face.face];
      const double change = face.solid_share * (wall - u);
      const double eps = face_void_fraction(medium, d, face.face);
      const double exchange = medium.has_grains ? medium.momentum_exchange[d][face.face] : 0.0;
      face.impulse = domain.control_volume[d][face.face] * (eps * rho + dt * exchange) * change;
      impulse[d] += face.impulse;
      u += change;
    }
  }
  return impulse;
}

Vec3 VolumeForcing::add_pressure(const VectorField& gradient, const GasDomain& domain,
                                 const FaceMedium& medium, double dt) {
  Vec3 impulse = Vec3::Zero();
  const double rho = domain.gas.density;
  for (int d = 0; d < 3; ++d) {
    for (Face& face : faces_[d]) {
      const double added = domain.control_volume[d][face.face] *
                           held_back(medium, rho, dt, d, face.face) * gradient[d][face.face];
      face.impulse += added;
      impulse[d] += added;
    }
  }
  return impulse;
}

}  // namespace gasgrain::cfd
