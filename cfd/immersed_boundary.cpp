// At an open face at distance 0 <= phi < dx from a body the predicted velocity becomes
//
//   (1 - w) u* + w u_IB(phi),     u_IB(s) = u_wall + a s + b s^2,
//   w = 1 / (1 + beta phi (phi + delta) / (eps mu)),     delta = 1.5 dx,
//
// the parabola along the wall normal which the trilinear interpolant of u* among faces of the same
// direction fits in value and normal slope at a point delta further out, s = phi + delta. Of a flow
// u(s) this interpolant's value is u(s) + q u'' and its slope u'(s + t), with
//
//   q = sum_e theta_e (1 - theta_e) h_e^2 n_e^2 / 2,     t = sum_e (1/2 - theta_e) h_e n_e^3
//
// for the shares theta of the upper faces, so that a parabola is met exactly wherever the wall cuts
// the grid. Second order around curved walls, with a third to a twentieth of the error of a linear
// profile; forcing by volume fractions would be first order with a wall position that depends on
// the time step. Where another wall is nearer to the point than this one the profile is linear.
//
// The weight w compares the thickness of the layer in which drag gives way to wall friction,
// sqrt(eps mu / beta), with the distance: inside a dense bed that layer is a hundred times thinner
// than a cell and imposing the profile there would act as a wall friction that does not exist. In
// gas without grains w = 1; without viscosity w = 0 (a frictionless gas slips).
//
// A moving body needs the same with its faces and distances at the end of the step.
#include "cfd/immersed_boundary.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gasgrain::cfd {

namespace {

constexpr double probe_cells = 1.5;  // delta / dx
constexpr double narrow = 0.75;      // of the distance that the point would have from one wall

double smallest_spacing(const GasDomain& domain) {
  double smallest = std::numeric_limits<double>::infinity();
  for (int d = 0; d < 3; ++d) {
    if (domain.varies[d]) smallest = std::min(smallest, domain.spacing[d]);
  }
  return std::isfinite(smallest) ? smallest : domain.spacing.minCoeff();
}

Vec3 outward_normal(const GasDomain& domain, int d, std::ptrdiff_t n) {
  const VectorField& gradient = domain.walls.normal[d];
  const Vec3 normal(gradient[0][n], gradient[1][n], gradient[2][n]);
  const double norm = normal.norm();
  return norm > 0.0 ? Vec3(normal / norm) : Vec3(Vec3::Zero());
}

}  // namespace

ImmersedBoundary::ImmersedBoundary(const GasDomain& domain) : varies_(domain.varies) {
  if (!domain.walls.has_bodies || domain.walls.spans_bodies) return;
  const double dx = smallest_spacing(domain);
  probe_length_ = probe_cells * dx;
  for (int d = 0; d < 3; ++d) {
    for_each_face(domain.decomposition, d, [&](int i, int j, int k) {
      const Field& part = domain.walls.takes_part[d];
      const std::ptrdiff_t n = part.index(i, j, k);
      const double phi = domain.walls.distance[d][n];
      if (part[n] == 0.0 || phi >= dx) return;
      Face face{.face = n,
                .base = n,
                .weight = {},
                .wall_weight = 1.0,
                .distance = phi,
                .body = static_cast<int>(domain.walls.nearest_body[d][n]),
                .position = domain.face_centre(d, i, j, k),
                .impulse = 0.0};
      set_profile(face, domain, d, outward_normal(domain, d, n));
      faces_[d].push_back(face);
    });
  }
}

void ImmersedBoundary::set_profile(Face& face, const GasDomain& domain, int d,
                                   const Vec3& normal) const {
  const Field& distance = domain.walls.distance[d];
  Vec3 share = Vec3::Zero();  // of the upper faces in each direction
  double q = 0.0, t = 0.0;
  for (int e = 0; e < 3; ++e) {
    if (!varies_[e]) continue;
    const double h = domain.spacing[e], offset = probe_length_ * normal[e] / h;
    const double whole = std::floor(offset);
    face.base += static_cast<std::ptrdiff_t>(whole) * distance.stride(e);
    share[e] = offset - whole;
    q += 0.5 * share[e] * (1.0 - share[e]) * std::pow(h * normal[e], 2);
    t += (0.5 - share[e]) * h * std::pow(normal[e], 3);
  }
  std::array<double, 8> value{}, slope{};
  double probe_distance = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    std::ptrdiff_t n = face.base;
    Vec3 factor;
    bool present = true;
    for (int e = 0; e < 3; ++e) {
      const bool upper = corner >> e & 1;
      factor[e] = upper ? share[e] : 1.0 - share[e];
      if (upper) n += distance.stride(e);
      present = present && (varies_[e] || !upper);
    }
    if (!present) continue;
    value[corner] = factor.prod();
    for (int e = 0; e < 3; ++e) {
      if (!varies_[e]) continue;
      const double others = factor[(e + 1) % 3] * factor[(e + 2) % 3];
      slope[corner] += (corner >> e & 1 ? 1.0 : -1.0) * normal[e] / domain.spacing[e] * others;
    }
    if (value[corner] != 0.0) probe_distance += value[corner] * distance[n];
  }
  const double phi = face.distance, s = phi + probe_length_;
  double a = phi / s, b = 0.0;  // the linear profile, between walls that face each other
  if (probe_distance > narrow * s) {
    a = phi * (2.0 * (s + t) - phi) / (s * s + 2.0 * s * t - 2.0 * q);
    b = phi - a * s;
  }
  for (int corner = 0; corner < 8; ++corner) {
    face.weight[corner] = a * value[corner] + b * slope[corner];
  }
  face.wall_weight = 1.0 - a;
}

double ImmersedBoundary::profile(const Face& face, const Field& velocity, double wall) const {
  double sum = face.wall_weight * wall;
  for (int corner = 0; corner < 8; ++corner) {
    if (face.weight[corner] == 0.0) continue;
    std::ptrdiff_t n = face.base;
    for (int e = 0; e < 3; ++e) n += (corner >> e & 1) * velocity.stride(e);
    sum += face.weight[corner] * velocity[n];
  }
  return sum;
}

double ImmersedBoundary::weight(const Face& face, int d, const GasDomain& domain,
                                const FaceMedium& medium) const {
  const double beta = medium.has_grains ? medium.momentum_exchange[d][face.face] : 0.0;
  const double eps = face_void_fraction(medium, d, face.face), phi = face.distance;
  return 1.0 / (1.0 + beta * phi * (phi + probe_length_) / (eps * domain.gas.viscosity));
}

ImmersedBoundary::Condition ImmersedBoundary::condition(const Face& face, int d,
                                                        const Field& velocity,
                                                        const GasDomain& domain,
                                                        const FaceMedium& medium) const {
  return {weight(face, d, domain, medium),
          profile(face, velocity, domain.walls.wall_velocity[d][face.face])};
}

// eps rho (1 + K) is what a change of u* is worth in the final velocity's balance.
double ImmersedBoundary::worth(const Face& face, int d, const GasDomain& domain,
                               const FaceMedium& medium, double dt) {
  const double beta = medium.has_grains ? medium.momentum_exchange[d][face.face] : 0.0;
  const double eps = face_void_fraction(medium, d, face.face);
  return domain.control_volume[d][face.face] * (eps * domain.gas.density + dt * beta);
}

Vec3 ImmersedBoundary::apply(VectorField& velocity, const GasDomain& domain,
                             const FaceMedium& medium, double dt) {
  Vec3 impulse = Vec3::Zero();
  if (domain.gas.viscosity == 0.0) return impulse;
  for (int d = 0; d < 3; ++d) {
    Field& u = velocity[d];
    std::vector<double>& changed = changed_;
    changed.clear();
    for (Face& face : faces_[d]) {
      const auto [w, profile] = condition(face, d, u, domain, medium);
      changed.push_back((1.0 - w) * u[face.face] + w * profile);
      face.impulse = worth(face, d, domain, medium, dt) * (changed.back() - u[face.face]);
      impulse[d] += face.impulse;
    }
    for (std::size_t m = 0; m < changed.size(); ++m) u[faces_[d][m].face] = changed[m];
  }
  return impulse;
}

void ImmersedBoundary::constrain(VectorField& residual, const VectorField& velocity,
                                 const VectorField& diagonal, const GasDomain& domain,
                                 const FaceMedium& medium) const {
  for (int d = 0; d < 3; ++d) {
    for (const Face& face : faces_[d]) {
      const auto [w, profile] = condition(face, d, velocity[d], domain, medium);
      const double difference = profile - velocity[d][face.face];
      double& row = residual[d][face.face];
      row = (1.0 - w) * row + w * diagonal[d][face.face] * difference;
    }
  }
}

void ImmersedBoundary::scale_density(FaceMedium& medium, const GasDomain& domain,
                                     double ratio) const {
  for (int d = 0; d < 3; ++d) {
    medium.density_scaling[d].fill(1.0);
    for (const Face& face : faces_[d]) {
      medium.density_scaling[d][face.face] = 1.0 + weight(face, d, domain, medium) * (ratio - 1.0);
    }
  }
}

Vec3 ImmersedBoundary::add_pressure(const VectorField& gradient, const GasDomain& domain,
                                    const FaceMedium& medium, double dt) {
  Vec3 impulse = Vec3::Zero();
  for (int d = 0; d < 3; ++d) {
    for (Face& face : faces_[d]) {
      const double added = domain.control_volume[d][face.face] *
                           held_back(medium, domain.gas.density, dt, d, face.face) *
                           gradient[d][face.face];
      face.impulse += added;
      impulse[d] += added;
    }
  }
  return impulse;
}

Vec3 ImmersedBoundary::impose(VectorField& velocity, const VectorField& solved,
                              const std::function<double(int, std::ptrdiff_t)>& old_gradient,
                              const GasDomain& domain, const FaceMedium& medium, double dt) {
  Vec3 impulse = Vec3::Zero();
  for (int d = 0; d < 3; ++d) {
    for (Face& face : faces_[d]) {
      double& u = velocity[d][face.face];
      const double returned = (1.0 - weight(face, d, domain, medium)) *
                              mobility(medium, domain.gas.density, dt, d, face.face) *
                              old_gradient(d, face.face);
      const double value = solved[d][face.face] + returned;
      face.impulse = worth(face, d, domain, medium, dt) * (value - u);
      impulse[d] += face.impulse;
      u = value;
    }
  }
  return impulse;
}

void set_solid_faces(VectorField& velocity, const GasDomain& domain) {
  for (int d = 0; d < 3; ++d) {
    const double* part = domain.walls.takes_part[d].data();
    const double* wall = domain.walls.wall_velocity[d].data();
    double* u = velocity[d].data();
    for_each_row(inner_faces(domain, d), velocity[d], [=](std::ptrdiff_t row, int length) {
      const double solid = sum_row(row, length, [=](auto n) { return part[n] == 0.0 ? 1.0 : 0.0; });
      if (solid == 0.0) return;
      for_row(row, length, [=](std::ptrdiff_t n) { u[n] = part[n] == 0.0 ? wall[n] : u[n]; });
    });
  }
}

}  // namespace gasgrain::cfd
