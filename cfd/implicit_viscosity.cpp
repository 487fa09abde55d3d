// Where cells are small or the gas is viscous, nu dt/h^2 <= 0.9/12 rules the step. With the stress
// at the end of the step it does not:
//
//   eps rho (v - u_n)/dt = [ convection ]_AB2 + c1 S(v) + c0 S(u_n) + c-1 S(u_n-1) + eps rho g
//                          + B (w - v) - eps grad p_old,       S(v) = div(eps tau(v)),
//   u* = v + (c/eps) grad p_old,
//
// w the velocity of the grains, and the projection goes on from u*. The old pressure makes v what u
// will be, but for the change of the pressure in a step: without it friction would act on a
// velocity that is off by dt grad p / rho, and a steady flow would depend on the step.
//
// Weights (r = dt_n / dt_n-1): those of second order at the middle of the step,
//
//   c1 = 1/2 + m/r,  c0 = 1/2 - m - m/r,  c-1 = m,
//
// with the m that makes what is much faster than the step fall most: c0^2 = 4 c1 c-1, a double root
// of -sqrt(c-1/c1). At r = 1 these are 9/16, 6/16, 1/16 with a factor of -1/3 per step (Ascher,
// Ruuth, Wetton, SIAM J. Numer. Anal. 32 (1995) 797: MCNAB); the trapezoidal rule has -1.
//
// All of the stress is implicit, the transposed part as well, which couples the components: split
// off with extrapolation it would be unstable for velocities that are not divergence-free, as they
// are next to bodies. On a face at 0 <= phi < dx of a body the row is
//
//   (1 - w) (row of the momentum) + w D (v - u_IB(v)) = 0,        D the diagonal,
//
// so that the neighbours feel the wall where it is (immersed_boundary.cpp). The old pressure has no
// part in such a face: its velocity is given, so nothing would answer what continuity asks of it
// and the pressure would grow from step to step. Instead u* = v there, and the pressure moves the
// face by c grad p as always, with a c of no more than the explicit limit's step dt_e: a face 1 + w
// (dt/dt_e - 1) times as heavy. The slip dt grad p/rho that explicit viscosity leaves on these
// faces so stays at that of dt_e, whatever the step. These rows are not symmetric: solved by
// BiCGStab (van der Vorst, SIAM J. Sci. Stat. Comput. 13 (1992) 631), scaled by the diagonal; its
// condition is about 1 + 12 nu dt/h^2, a few iterations at twenty times the explicit limit.
// The pressure of the shortest waves falls behind by about c1 12 nu dt/h^2 steps (v answers to the
// old pressure against friction); the next steps make up for it. Momentum stays exact whatever the
// tolerance leaves: u* follows from S(v) by the equation of motion, except next to bodies, where
// the difference is their force.
#include "cfd/implicit_viscosity.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "cfd/ghost_values.hpp"
#include "cfd/halo_exchange.hpp"
#include "cfd/solve_failure.hpp"
#include "cfd/viscous_stress.hpp"
#include "coupling/shared/error.hpp"

namespace gasgrain::cfd {

namespace {

constexpr double tolerance = 1e-9;  // residual over the right-hand side, 2-norms
constexpr int most_iterations = 1000;
constexpr int attempts = 5;  // from the true residual

VectorField fields(const Index3& size) {
  return {Field(size), Field(size), Field(size)};
}

}  // namespace

StressWeights stress_weights(double dt, double previous_dt) {
  GASGRAIN_ASSERT(dt > 0.0 && previous_dt >= 0.0);
  if (previous_dt == 0.0) return {};
  const double s = previous_dt / dt;  // 1/r
  const double sum = 3.0 + s, difference = 1.0 - s;
  const double m = 0.5 / (sum + std::sqrt(sum * sum - difference * difference));
  return {.coming = 0.5 + m * s, .now = 0.5 - m - m * s, .before = m};
}

struct ImplicitViscosity::Equation {
  const FaceMedium& medium;
  const ImmersedBoundary& boundary;
  Step step;
};

ImplicitViscosity::ImplicitViscosity(const GasDomain& domain) : domain_(domain) {
  for (VectorField* field :
       {&right_hand_side_, &velocity_, &stress_, &nothing_, &at_rest_, &diagonal_, &residual_,
        &shadow_, &direction_, &direction_image_, &scaled_, &image_}) {
    *field = fields(domain.size());
  }
}

// visit(direction, its owned faces) for the components that are solved for.
template <class Visit>
void ImplicitViscosity::for_each_component(const Visit& visit) const {
  for (int d = 0; d < 3; ++d) {
    if (domain_.solved[d]) visit(d, all_faces(domain_, d));
  }
}

double ImplicitViscosity::product(const VectorField& a, const VectorField& b) const {
  double sum = 0.0;
  for_each_component([&](int d, const IndexBox& faces) {
    sum += sum_box(faces, a[d],
                   [x = a[d].data(), y = b[d].data()](std::ptrdiff_t n) { return x[n] * y[n]; });
  });
  return sum_over_ranks(domain_.decomposition, sum);
}

double ImplicitViscosity::norm(const VectorField& a) const {
  return std::sqrt(product(a, a));
}

// Of faces away from walls; next to them it is a little more.
void ImplicitViscosity::set_diagonal(const Equation& equation) {
  const double rho = domain_.gas.density, dt = equation.step.dt;
  for_each_component([&](int d, const IndexBox& faces) {
    double curvature = 0.0;  // 1/m^2
    for (int e = 0; e < 3; ++e) {
      if (!domain_.varies[e]) continue;
      curvature += (e == d ? 4.0 : 2.0) / (domain_.spacing[e] * domain_.spacing[e]);
    }
    const double stress = dt * equation.step.coming * domain_.gas.viscosity * curvature;
    double* diagonal = diagonal_[d].data();
    if (!equation.medium.has_grains) {
      for_box(faces, diagonal_[d], [=](std::ptrdiff_t n) { diagonal[n] = rho + stress; });
      return;
    }
    const double* eps = equation.medium.void_fraction[d].data();
    const double* b = equation.medium.momentum_exchange[d].data();
    for_box(faces, diagonal_[d],
            [=](std::ptrdiff_t n) { diagonal[n] = eps[n] * (rho + stress) + dt * b[n]; });
  });
}

void ImplicitViscosity::evaluate_residual(VectorField& residual, VectorField& velocity,
                                          const Equation& equation, const VectorField& given) {
  const FaceMedium& medium = equation.medium;
  fill_velocity_ghosts(domain_, medium, velocity);
  const double rho = domain_.gas.density, dt = equation.step.dt;
  const double share = dt * equation.step.coming;
  for_each_component([&](int d, const IndexBox& faces) {
    const double* part = domain_.walls.takes_part[d].data();
    const double* v = velocity[d].data();
    const double* right = given[d].data();
    const double* eps = medium.void_fraction[d].data();
    const double* b = medium.momentum_exchange[d].data();
    double* stress = stress_[d].data();
    double* r = residual[d].data();
    for_each_part(faces, [&](const IndexBox& box) {
      for_box(box, stress_[d], [=](std::ptrdiff_t n) { stress[n] = 0.0; });
      add_viscous_stress(stress_[d], domain_, box, medium, velocity, d);
      if (medium.has_grains) {
        for_box(box, stress_[d], [=](std::ptrdiff_t n) {
          r[n] = part[n] * (right[n] - (eps[n] * rho + dt * b[n]) * v[n] + share * stress[n]);
        });
      } else {
        for_box(box, stress_[d], [=](std::ptrdiff_t n) {
          r[n] = part[n] * (right[n] - rho * v[n] + share * stress[n]);
        });
      }
    });
  });
  if (domain_.walls.has_bodies) {
    equation.boundary.constrain(residual, velocity, diagonal_, domain_, medium);
  }
}

void ImplicitViscosity::apply(VectorField& image, VectorField& argument, const Equation& equation) {
  evaluate_residual(image, argument, equation, nothing_);
  for_each_component([&](int d, const IndexBox& faces) {
    for_box(faces, image[d], [r = image[d].data(), rest = at_rest_[d].data()](std::ptrdiff_t n) {
      r[n] = rest[n] - r[n];
    });
  });
}

void ImplicitViscosity::scale(VectorField& result, const VectorField& a) {
  for_each_component([&](int d, const IndexBox& faces) {
    for_box(faces, result[d],
            [z = result[d].data(), x = a[d].data(),
             diagonal = diagonal_[d].data()](std::ptrdiff_t n) { z[n] = x[n] / diagonal[n]; });
  });
}

// BiCGStab from residual_ until its norm is `target`; returns the iterations.
int ImplicitViscosity::iterate(const Equation& equation, double target, int most) {
  const auto add = [&](VectorField& to, double factor, const VectorField& from) {
    for_each_component([&](int d, const IndexBox& faces) {
      // scaled_ carries the sides' velocities on faces that do not take part
      for_box(faces, to[d],
              [x = to[d].data(), y = from[d].data(), part = domain_.walls.takes_part[d].data(),
               factor](std::ptrdiff_t n) { x[n] += part[n] * factor * y[n]; });
    });
  };
  shadow_ = residual_;
  double previous = 1.0, alpha = 0.0, omega = 1.0;
  for (int n = 1; n <= most; ++n) {
    const double product_now = product(shadow_, residual_);
    const double beta = n > 1 ? product_now / previous * (alpha / omega) : 0.0;
    previous = product_now;
    for_each_component([&](int d, const IndexBox& faces) {
      for_box(faces, direction_[d],
              [p = direction_[d].data(), r = residual_[d].data(), v = direction_image_[d].data(),
               beta, omega](std::ptrdiff_t m) {
                p[m] = beta != 0.0 ? r[m] + beta * (p[m] - omega * v[m]) : r[m];
              });
    });
    scale(scaled_, direction_);
    apply(direction_image_, scaled_, equation);
    const double projection = product(shadow_, direction_image_);
    if (projection == 0.0) return n;  // starts anew from the true residual
    alpha = product_now / projection;
    add(velocity_, alpha, scaled_);
    add(residual_, -alpha, direction_image_);
    scale(scaled_, residual_);
    apply(image_, scaled_, equation);
    const double length = product(image_, image_);
    if (length == 0.0) return n;
    omega = product(image_, residual_) / length;
    add(velocity_, omega, scaled_);
    add(residual_, -omega, image_);
    if (!(norm(residual_) > target) || omega == 0.0 || product_now == 0.0) return n;
  }
  return most;
}

int ImplicitViscosity::solve(const VectorField& velocity, const FaceMedium& medium,
                             const ImmersedBoundary& boundary, const Step& step) {
  const Equation equation{medium, boundary, step};
  set_diagonal(equation);
  for_each_component([&](int d, const IndexBox&) { scaled_[d].fill(0.0); });
  evaluate_residual(at_rest_, scaled_, equation, nothing_);
  velocity_ = velocity;
  int iterations = 0;
  double reached = 0.0, target = 0.0;
  for (int attempt = 0; attempt <= attempts; ++attempt) {
    evaluate_residual(residual_, velocity_, equation, right_hand_side_);
    reached = norm(residual_);
    if (attempt == 0) target = tolerance * std::max(norm(right_hand_side_), reached);
    if (!(reached > target)) return iterations;
    // where the recursive residual has drifted from the true one, a little further
    const double aim = attempt == 0 ? target : 0.1 * target;
    if (attempt < attempts) iterations += iterate(equation, aim, most_iterations);
  }
  std::ostringstream message;
  message << "the viscous stress at the end of the step is not solved: residual " << reached
          << " after " << iterations << " iterations, asked for " << target
          << "; take a smaller step or numerics.viscosity = \"explicit\"";
  throw SolveFailure(message.str());
}

}  // namespace gasgrain::cfd
