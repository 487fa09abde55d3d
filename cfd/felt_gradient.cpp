// Grains that displace gas must set it in motion. In the volume-averaged equations that force is
// part of -V grad p: where solids of density rho_s move as one, eps u + (1 - eps) v is fixed, hence
// du/dt = -(1 - eps)/eps dv/dt, and of -grad p = rho du/dt + ... the grains get the inertia of
// a = (1 - eps) rho/(eps rho_s) times their own mass. They get it an interval T after the motion
// that caused it,
//
//   v_n+1 - v_n = -a (v_n - v_n-1),
//
// which grows when a > 1, whatever T. So grains feel not grad p but h, in the interval n
//
//   h = h_n-1 + theta (grad p - h_n-1),           theta = 1/(1 + m (1 - eps)),
//
// and the gas keeps the rest, -grad p + (1 - eps) h: its share of grad p is 1 - theta (1 - eps)
// instead of eps, and (1 - theta)(1 - eps) h_n-1 is known. The two forces add up to grad p at every
// instant, so momentum is exchanged as without lag. Once nothing changes, h = grad p. Of an
// acceleration that the grains felt as h_n-1 they feel next
//
//   h_n = [ 1 - theta - theta (1 - eps) rho/rho_s ] / [ 1 - theta (1 - eps) ] h_n-1,
//
// nothing at m = rho/rho_s, and with the m = 2 rho/rho_s used here a share b/(eps + 2 b) < 1/2,
// b = (1 - eps) rho/rho_s. Twice the least, because grains in contact vibrate: an interval of half
// a period puts the delayed force in step with the vibration. With the held drag, at any period,
// the growth per interval is then no more than that of heavy grains (eigenvalues of the recursion
// of displacement, velocity, gas velocity and h: docs/coupling.md).
//
// Several gas steps of an interval share its h_n-1: what they give is linear in their grad p, so
// their means obey the same recursion. They also share the void fraction at its end for what grains
// feel, (1 - eps_end) h, although eps itself changes from step to step: the grains, which gather
// with the kernel of their last places, then get in the mean exactly what the gas has felt, also
// from where they have left. The difference is of the order of the motion in an interval, as is
// the delay of the force itself.
#include "cfd/felt_gradient.hpp"

#include "cfd/halo_exchange.hpp"
#include "cfd/loops.hpp"

namespace gasgrain::cfd {

namespace {

// Below it the delayed force is no more than 2 % of the grains' inertia at eps = 0.3.
constexpr double negligible_ratio = 0.01;

}  // namespace

double lag_of(double density_ratio) {
  return density_ratio >= negligible_ratio ? 2.0 * density_ratio : 0.0;
}

void FeltGradient::allocate() {
  for (VectorField* field : {&last_, &felt_}) {
    for (int d = 0; d < 3; ++d) {
      if ((*field)[d].count() == 0) (*field)[d] = Field(domain_.size());
    }
  }
}

void FeltGradient::add_held(VectorField& velocity, const FaceMedium& medium, const Vec3& driving,
                            double dt) {
  allocate();
  const double rho = domain_.gas.density;
  for (int d = 0; d < 3; ++d) {
    if (!domain_.solved[d]) continue;
    for_box(all_faces(domain_, d), velocity[d],
            [=, lag = medium.lag, u = velocity[d].data(), part = domain_.walls.takes_part[d].data(),
             sharing = medium.sharing_void_fraction()[d].data(),
             eps = medium.void_fraction[d].data(), b = medium.momentum_exchange[d].data(),
             last = last_[d].data(), g = driving[d]](std::ptrdiff_t n) {
              u[n] += part[n] * dt * pressure_share(lag, sharing[n]).last * (last[n] - g) /
                      (eps[n] * rho + dt * b[n]);
            });
  }
}

void FeltGradient::observe(const FaceMedium& medium, const VectorField& gradient) {
  allocate();
  const double lag = medium.lag;
  for (int d = 0; d < 3; ++d) {
    const double* eps = medium.sharing_void_fraction()[d].data();
    const double* part = domain_.walls.takes_part[d].data();
    for (std::size_t n = 0; n < felt_[d].count(); ++n) {
      const double theta = 1.0 / (1.0 + lag * (1.0 - eps[n]));
      felt_[d][n] = part[n] * (last_[d][n] + theta * (gradient[d][n] - last_[d][n]));
    }
  }
}

Vec3 kept_force(const GasDomain& domain, const FaceMedium& medium, const VectorField& gradient,
                const VectorField& felt) {
  Vec3 sum = Vec3::Zero();
  for (int d = 0; d < 3; ++d) {
    sum[d] =
        sum_box(all_faces(domain, d), gradient[d],
                [volume = domain.control_volume[d].data(), eps = medium.void_fraction[d].data(),
                 sharing = medium.sharing_void_fraction()[d].data(), g = gradient[d].data(),
                 h = felt[d].data()](std::ptrdiff_t n) {
                  return volume[n] * ((1.0 - eps[n]) * g[n] - (1.0 - sharing[n]) * h[n]);
                });
  }
  return sum;
}

void FeltGradient::visit_state(StateArchive& archive) {
  allocate();
  archive.faces("felt_gradient", last_);
  if (archive.restores()) fill_ghosts(domain_.decomposition, last_);
}

}  // namespace gasgrain::cfd
