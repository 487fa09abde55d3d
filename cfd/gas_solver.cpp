// Volume-averaged Navier-Stokes equations, model A, for the gas between grains of void fraction eps
// and momentum exchange B = sum of beta/(1-eps) V per volume (eq 11-16 of Mori, Wu, Sakai 2019):
//
//   d(eps)/dt + div(eps u) = 0
//   eps rho du/dt + rho (div(eps u u) - u div(eps u)) = -eps grad p + div(eps tau) + eps rho g
//                                                       + B (v - u) + F_body
//
// on a staggered grid. Per face K = dt B/(eps rho); one step from u_n to u:
//
//   1  eps rho (u^ - u_n)/dt = [ -rho(div(eps u u) - u div(eps u)) + div(eps tau) ]_AB2
//                              + eps rho g + B v
//   2  u* = u^ /(1 + K)
//   3  u* near bodies blended with their no-slip profile, u* = u_wall inside them
//      (numerics.immersed_boundary = "volume-forcing" instead: volume_forcing.cpp)
//   4  div( a c grad p ) = (1 - alpha)(eps_new - eps_old)/dt - swept + div(a eps u*),
//                          c = eps dt/(rho (1 + K))
//   5  u = u* - (c/eps) grad p
//
// Light grains feel the pressure gradient with a lag, and in an interval of several steps grains
// share in it by the void fraction at its end: felt_gradient.cpp adds to 2 and changes c.
//
// With viscosity = implicit the stress of the bracket is taken at the end of the step, together
// with step 3 (implicit_viscosity.cpp). With time_scheme = rk2 (Heun) steps 1 to 5 are taken twice
// from u_n: first with the bracket of u_n alone, then with the mean of that and the bracket of what
// the first stage gave.
//
// a is the open share of a face, alpha the solid share of a cell, both with the bodies where they
// are at the end of the step; swept is the volume that moving bodies leave (moving_walls.cpp). eps,
// B and B v of a face are means over the shares its cells' grains have in it. The bracket is
// evaluated with the void fraction of its own time; gravity is taken with the new one, so that gas
// at rest stays at rest while grains move. Drag is implicit in 2 and in 4, without which a bed's
// pressure drop would be too low by 1/(1 + K) (only 2) or the step limited to 2 eps rho / beta
// (explicit).
#include "cfd/gas_solver.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include "cfd/gas_state.hpp"
#include "cfd/ghost_values.hpp"
#include "cfd/halo_exchange.hpp"
#include "cfd/momentum_budget.hpp"
#include "cfd/outlet_flow.hpp"
#include "cfd/solve_failure.hpp"
#include "cfd/time_step.hpp"
#include "coupling/shared/error.hpp"

namespace gasgrain::cfd {

namespace {

// Bodies moved to within this share of a step of its end stand where they shall.
constexpr double walls_are_there = 1e-9;

}  // namespace

void GasSolver::State::evaluate_slope() {
  std::swap(slope, old_slope);
  if (domain.has_motion) {  // the volumes of faces have changed
    if (implicit_viscosity) {
      old_slope.viscous = volume_integral(domain, old_slope.stress);
      old_slope.convection = volume_integral(domain, old_slope.total);
    } else {
      old_slope.convection = volume_integral(domain, old_slope.total) - old_slope.viscous;
    }
  }
  slope_evaluation.evaluate(slope, medium, velocity);
}

// Steps 1 and 2 on the faces that take part.
double GasSolver::State::predict(double dt, const AdamsBashforth& weights,
                                 const VectorField& slope_now, const VectorField& slope_before) {
  const double rho = domain.gas.density;
  double magnitudes = 0.0;
  for (int d = 0; d < 3; ++d) {
    if (!domain.solved[d]) continue;
    const double g = domain.gas.gravity[d] - driving.value()[d] / rho;
    const double* part = domain.walls.takes_part[d].data();
    const double* now = slope_now[d].data();
    const double* before = slope_before[d].data();
    const double* eps = medium.void_fraction[d].data();
    const double* b = medium.momentum_exchange[d].data();
    const double* bv = medium.exchange_momentum[d].data();
    double* u = velocity[d].data();
    if (medium.has_grains) {
      magnitudes += sum_box(all_faces(domain, d), velocity[d], [=](std::ptrdiff_t n) {
        const double mass = eps[n] * rho;
        const double force = weights.now * now[n] + weights.before * before[n] + bv[n];
        const double predicted = (mass * (u[n] + dt * g) + dt * force) / (mass + dt * b[n]);
        u[n] = part[n] != 0.0 ? predicted : u[n];
        return std::abs(u[n]);
      });
    } else {
      magnitudes += sum_box(all_faces(domain, d), velocity[d], [=](std::ptrdiff_t n) {
        const double force = weights.now * now[n] + weights.before * before[n];
        u[n] = part[n] != 0.0 ? u[n] + dt * (force / rho + g) : u[n];
        return std::abs(u[n]);
      });
    }
  }
  return magnitudes;
}

// Of the pressure of the last step, without the driving gradient, which acts with gravity.
double GasSolver::State::old_gradient(int d, std::ptrdiff_t n) const {
  if (steps_from_start < settled_steps) return 0.0;
  return projection.pressure_gradient()[d][n] - domain.walls.takes_part[d][n] * driving.value()[d];
}

// eps rho (u + dt g) + dt (force + B v - eps grad p_old)
void GasSolver::State::set_right_hand_side(VectorField& result, double dt) const {
  const double rho = domain.gas.density;
  for (int d = 0; d < 3; ++d) {
    if (!domain.solved[d]) continue;
    const double g = domain.gas.gravity[d] - driving.value()[d] / rho;
    const double* total = forces[d].data();
    const double* eps = medium.void_fraction[d].data();
    const double* bv = medium.exchange_momentum[d].data();
    const double* u = velocity[d].data();
    double* right = result[d].data();
    const auto set = [&](const auto& void_fraction, const auto& drag) {
      for_box(all_faces(domain, d), velocity[d], [=, this](std::ptrdiff_t n) {
        right[n] = void_fraction(n) * (rho * (u[n] + dt * g) - dt * old_gradient(d, n)) +
                   dt * (total[n] + drag(n));
      });
    };
    if (medium.has_grains) {
      set([=](std::ptrdiff_t n) { return eps[n]; }, [=](std::ptrdiff_t n) { return bv[n]; });
    } else {
      set([](std::ptrdiff_t) { return 1.0; }, [](std::ptrdiff_t) { return 0.0; });
    }
  }
}

// See implicit_viscosity.cpp.
double GasSolver::State::predict_implicitly(StepReport& report, double dt,
                                            const AdamsBashforth& weights) {
  const auto add = [&](const VectorField& field, double weight) {
    for (int d = 0; d < 3; ++d) {
      for_box(all_faces(domain, d), forces[d],
              [total = forces[d].data(), value = field[d].data(), weight](std::ptrdiff_t n) {
                total[n] += weight * value[n];
              });
    }
  };
  stress_weights = cfd::stress_weights(dt, previous_dt);
  for (Field& component : forces) component.fill(0.0);
  add(slope.total, weights.now);
  add(old_slope.total, weights.before);
  add(slope.stress, stress_weights.now);
  add(old_slope.stress, stress_weights.before);
  set_right_hand_side(implicit_viscosity->right_hand_side(), dt);
  set_solid_faces(velocity, domain);
  report.viscous_iterations = implicit_viscosity->solve(
      velocity, medium, immersed_boundary, {.dt = dt, .coming = stress_weights.coming});
  add(implicit_viscosity->stress(), stress_weights.coming);
  if (medium.has_scaling) {
    const double ratio = dt / explicit_viscous_step(domain, TimeScheme::ab2);
    immersed_boundary.scale_density(medium, domain, std::max(ratio, 1.0));
  }
  return predict(dt, {.now = 1.0, .before = 0.0}, forces, forces);
}

Vec3 GasSolver::State::impose_bodies(double dt) {
  if (domain.walls.spans_bodies) return volume_forcing.apply(velocity, domain, medium, dt);
  if (!implicit_viscosity) return immersed_boundary.apply(velocity, domain, medium, dt);
  return immersed_boundary.impose(
      velocity, implicit_viscosity->velocity(),
      [this](int d, std::ptrdiff_t n) { return old_gradient(d, n); }, domain, medium, dt);
}

void GasSolver::State::take_stage(StepReport& report, PassClock& clock, double dt,
                                  const AdamsBashforth& weights, const Field* void_before) {
  const double magnitudes = implicit_viscosity ? predict_implicitly(report, dt, weights)
                                               : predict(dt, weights, slope.total, old_slope.total);
  check_finite(magnitudes, dt);
  if (medium.lag > 0.0) felt.add_held(velocity, medium, driving.value(), dt);
  clock.finish(report.times, Pass::predict);
  if (domain.has_motion) set_solid_faces(velocity, domain);  // else they have what they had
  fill_velocity_ghosts(domain, medium, velocity);
  if (domain.walls.has_bodies) {
    report.momentum.body = impose_bodies(dt);
    fill_velocity_ghosts(domain, medium, velocity);
  }
  if (driving.present()) {
    driving.keep_mean_flow(velocity, medium, dt);
    fill_velocity_ghosts(domain, medium, velocity);
  }
  clock.finish(report.times, Pass::boundary);
  const Projection::Balance balance = projection.set_equation(medium, void_before, velocity, dt);
  report.removed_mean = balance.removed_mean;
  report.swept_imbalance = balance.swept_imbalance;
  clock.finish(report.times, Pass::equation);
  report.pressure = projection.solve(pressure);
  clock.finish(report.times, Pass::solve);
  check_finite(projection.correct(velocity, pressure, medium, dt), dt);
  if (domain.walls.spans_bodies) {
    report.momentum.body +=
        volume_forcing.add_pressure(projection.pressure_gradient(), domain, medium, dt);
  }
  if (implicit_viscosity && domain.walls.has_bodies) {
    report.momentum.body +=
        immersed_boundary.add_pressure(projection.pressure_gradient(), domain, medium, dt);
  }
  if (driving.present()) driving.add_to(projection.pressure_gradient());
  fill_velocity_ghosts(domain, medium, velocity);
}

// Adds this rank's share of body_stress to the budget.
void GasSolver::State::measure_loads(MomentumBudget& budget, double dt,
                                     const AdamsBashforth& weights) {
  if (domain.walls.spans_bodies) {
    loads.start(volume_forcing);
  } else {
    loads.start(immersed_boundary);
  }
  loads.add_stress(slope.total, dt * weights.now);
  loads.add_stress(old_slope.total, dt * weights.before);
  if (implicit_viscosity) {
    loads.add_stress(implicit_viscosity->stress(), dt * stress_weights.coming);
    loads.add_stress(slope.stress, dt * stress_weights.now);
    loads.add_stress(old_slope.stress, dt * stress_weights.before);
  }
  budget.body_stress = -loads.stress_impulse();
  loads.add_pressure(pressure, projection.pressure_gradient(), driving.value(), dt);
  loads.finish(dt);
}

// Momentum that the stress gave to this rank's gas, N s.
Vec3 GasSolver::State::implicit_viscous_impulse(double dt) const {
  const Vec3 coming = volume_integral(domain, implicit_viscosity->stress());
  return dt * (stress_weights.coming * coming + stress_weights.now * slope.viscous +
               stress_weights.before * old_slope.viscous);
}

// The grains' share of the pressure is what they feel.
void GasSolver::State::observe_felt_gradient(MomentumBudget& budget, double dt) {
  if (medium.lag > 0.0) felt.observe(medium, projection.pressure_gradient());
  const Vec3 kept =
      dt * kept_force(domain, medium, projection.pressure_gradient(), felt_gradient());
  budget.pressure -= kept;
  budget.pressure_on_grains += kept;
}

// `magnitudes` is the sum of |u| on this rank's faces, `speeds` those of the last step.
void GasSolver::State::check_finite(double magnitudes, double dt) const {
  if (std::isfinite(sum_over_ranks(domain.decomposition, magnitudes))) return;
  std::ostringstream message;
  message << "the gas velocity is no longer finite at t = " << time << " s after a step of " << dt
          << " s; the largest velocity before it was " << speeds.maxCoeff()
          << " m/s. Take a smaller step, or look for grains or inlets that drive it";
  throw SolveFailure(message.str());
}

StepReport GasSolver::advance(double dt) {
  State& s = *state_;
  const GasDomain& domain = s.domain;
  GASGRAIN_ASSERT(dt > 0.0 && std::isfinite(dt));
  StepReport report;
  MomentumBudget& budget = report.momentum;
  const bool two_stages = s.gas_case.numerics.time_scheme == TimeScheme::rk2;
  AdamsBashforth weights = two_stages ? AdamsBashforth{} : adams_bashforth(dt, s.previous_dt);
  const double end = s.body_clock + s.time + dt;
  if (end > domain.walls_time + walls_are_there * dt) s.move_bodies(end);
  const bool had_grains = s.medium.has_grains;
  s.old_void_fraction = s.medium.cell_void_fraction;
  PassClock clock;

  s.evaluate_slope();
  clock.finish(report.times, Pass::slope);
  const Vec3 momentum_at_start =
      s.momentum ? *s.momentum : gas_momentum(domain, s.medium, s.velocity);
  const Vec3 momentum_before = momentum_at_start - s.momentum_of_moved_walls;
  s.momentum_of_moved_walls = Vec3::Zero();
  update(s.medium, domain, s.grains);
  if (s.medium.lag == 0.0) s.felt.forget();
  const bool any_grains = had_grains || s.medium.has_grains;
  const Field* const old_void_fraction = any_grains ? &s.old_void_fraction : nullptr;
  const Vec3 momentum_with_new_void =
      any_grains ? gas_momentum(domain, s.medium, s.velocity) : momentum_at_start;
  clock.finish(report.times, Pass::medium);

  s.domain.sides.set_time(s.time + dt);
  if (two_stages) {
    s.start = s.velocity;
    s.take_stage(report, clock, dt, weights, old_void_fraction);
    s.evaluate_slope();
    clock.finish(report.times, Pass::slope);
    std::swap(s.velocity, s.start);
    weights = {.now = 0.5, .before = 0.5};
  }
  const PressureReport first = report.pressure;
  s.take_stage(report, clock, dt, weights, old_void_fraction);
  report.pressure.iterations += first.iterations;
  report.pressure.fallbacks += first.fallbacks;
  if (s.driving.present()) s.driving.observe(s.velocity, s.medium);
  s.time += dt;
  s.previous_dt = dt;
  s.steps_from_start = std::min(s.steps_from_start + 1, settled_steps);
  report.backflow = backflow(domain, s.medium, s.velocity);
  report.driving_gradient = s.driving.value();
  report.divergence = s.projection.divergence(s.medium, old_void_fraction, s.velocity, dt);
  s.speeds = largest_speeds(domain, s.velocity);
  report.largest_speed = s.speeds.maxCoeff();
  report.courant_number = dt * s.speeds.cwiseQuotient(domain.spacing).maxCoeff();
  clock.finish(report.times, Pass::correct);
  budget.convection =
      momentum_with_new_void - momentum_before +
      dt * (weights.now * s.slope.convection + weights.before * s.old_slope.convection);
  budget.viscous =
      s.implicit_viscosity
          ? s.implicit_viscous_impulse(dt)
          : dt * (weights.now * s.slope.viscous + weights.before * s.old_slope.viscous);
  if (domain.walls.has_bodies) s.measure_loads(budget, dt, weights);
  s.momentum =
      add_forces(budget, domain, s.medium, s.velocity, s.projection.pressure_gradient(), dt);
  if (s.medium.shares_apart()) s.observe_felt_gradient(budget, dt);
  budget.stored = *s.momentum - momentum_before;
  add_pressure_reactions(budget, domain, s.uneven_cells, s.pressure,
                         s.projection.pressure_gradient(), s.driving.value(), dt);
  sum_over_ranks(domain.decomposition, budget);
  clock.finish(report.times, Pass::budget);
  if (s.means.started()) {
    s.means.add(s.velocity, s.felt_gradient(), dt);
  } else if (s.medium.lag > 0.0) {
    s.felt.finish_interval(s.felt.value());
  }
  return report;
}

double GasSolver::largest_stable_step() const {
  return step_limits().smallest();
}

StepLimits GasSolver::step_limits() const {
  const GasProperties& gas = state_->domain.gas;
  return cfd::step_limits(state_->domain, state_->speeds,
                          gas.gravity - state_->driving.value() / gas.density,
                          state_->gas_case.numerics);
}

}  // namespace gasgrain::cfd
