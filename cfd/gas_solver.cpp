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
// With time_scheme = rk2 (Heun) steps 1 to 5 are taken twice from u_n: first with the bracket of
// u_n alone, then with the mean of that and the bracket of what the first stage gave.
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
#include <optional>
#include <sstream>
#include <utility>

#include "cfd/body_loads.hpp"
#include "cfd/boundary_checks.hpp"
#include "cfd/convection.hpp"
#include "cfd/driving_gradient.hpp"
#include "cfd/face_medium.hpp"
#include "cfd/gas_domain.hpp"
#include "cfd/ghost_values.hpp"
#include "cfd/halo_exchange.hpp"
#include "cfd/immersed_boundary.hpp"
#include "cfd/interval_means.hpp"
#include "cfd/momentum_budget.hpp"
#include "cfd/moving_walls.hpp"
#include "cfd/outlet_flow.hpp"
#include "cfd/projection.hpp"
#include "cfd/solve_failure.hpp"
#include "cfd/time_step.hpp"
#include "cfd/viscous_stress.hpp"
#include "cfd/volume_forcing.hpp"
#include "coupling/shared/error.hpp"

namespace gasgrain::cfd {

namespace {

// Bodies moved to within this share of a step of its end stand where they shall.
constexpr double walls_are_there = 1e-9;

// The bracket of step 1 at one time, N/m^3 on faces, and its integrals over this rank, N.
struct Slope {
  VectorField total;
  Vec3 convection = Vec3::Zero();
  Vec3 viscous = Vec3::Zero();
};

VectorField fields(const Index3& size) {
  return {Field(size), Field(size), Field(size)};
}

GrainPhase no_grains(const Index3& size) {
  return {Field(size, 1.0), Field(size), fields(size)};
}

}  // namespace

struct GasSolver::State {
  State(const GasCase& given, MPI_Comm communicator);

  void set_velocity(const std::function<Vec3(const Vec3&)>& function);
  bool move_bodies(double new_time);  // the shape of some body has moved
  void follow_walls(const VectorField& took_part);
  void evaluate_slope();
  void predict(double dt, const AdamsBashforth& weights);
  // Steps 1 to 5 with the slopes at hand.
  void take_stage(StepReport& report, PassClock& clock, double dt, const AdamsBashforth& weights,
                  const Field* void_before);
  void measure_loads(MomentumBudget& budget, double dt, const AdamsBashforth& weights);
  void check_finite(double dt, double speed_before) const;
  // Face values as the grains of a cell see them.
  void sample(VectorField& velocity, VectorField& pressure_gradient, const VectorField& u,
              const VectorField& gradient) const;
  void visit(StateArchive& archive);
  void visit_grains(StateArchive& archive);
  void rebuild();

  GasCase gas_case;
  GasDomain domain;
  FaceMedium medium;
  GrainPhase grains;
  ImmersedBoundary immersed_boundary;
  VolumeForcing volume_forcing;  // takes its place when the walls span bodies
  BodyLoads loads;
  Projection projection;
  DrivingGradient driving;
  VectorField velocity;
  VectorField start;           // velocity before the first stage of two
  Vec3 speeds = Vec3::Zero();  // largest |u| per direction of all ranks, m/s
  Field pressure;
  Field old_void_fraction;  // of the cells at the start of the step
  Slope slope, old_slope;
  std::optional<Vec3> momentum;  // of this rank's gas, while it is what the last step left, N s
  IntervalMeans means;
  double time = 0.0, previous_dt = 0.0;
  double body_clock = 0.0;                      // s, of moving bodies at time = 0
  Vec3 momentum_of_moved_walls = Vec3::Zero();  // change of this rank's gas momentum by them, N s
};

GasSolver::State::State(const GasCase& given, MPI_Comm communicator)
    : gas_case(given),
      domain(given, communicator),
      medium(make_face_medium(domain)),
      grains(no_grains(domain.size())),
      immersed_boundary(domain),
      volume_forcing(domain),
      loads(domain),
      projection(domain, given.numerics),
      driving(domain),
      velocity(fields(domain.size())),
      pressure(domain.size()) {
  slope.total = old_slope.total = fields(domain.size());
  set_velocity([&](const Vec3&) { return gas_case.initial.velocity; });
  check_boundaries(domain, projection.regions());
}

void GasSolver::State::set_velocity(const std::function<Vec3(const Vec3&)>& function) {
  const Index3& first = domain.decomposition.block().lower;
  for (int d = 0; d < 3; ++d) {
    for_each_face(domain.decomposition, d, [&](int i, int j, int k) {
      Vec3 steps(i + first[0] + 0.5, j + first[1] + 0.5, k + first[2] + 0.5);
      steps[d] -= 0.5;
      const Vec3 x = domain.decomposition.grid().lower + steps.cwiseProduct(domain.spacing);
      velocity[d](i, j, k) = domain.walls.takes_part[d](i, j, k) * function(x)[d];
    });
  }
  set_solid_faces(velocity, domain);
  fill_velocity_ghosts(domain, medium, velocity);
  speeds = largest_speeds(domain, velocity);
  momentum.reset();
  previous_dt = 0.0;
}

// Cells and faces that the bodies give free keep the velocity of the wall and get the pressure next
// to them; grains of cells that close go to their neighbours.
bool GasSolver::State::move_bodies(double new_time) {
  if (!domain.has_motion) return false;
  if (!domain.walls_move_until(new_time)) {
    domain.move_to(new_time);
    return false;
  }
  const Vec3 momentum_before = gas_momentum(domain, medium, velocity);
  const Field old_open_share = domain.open_share;
  const VectorField took_part = domain.walls.takes_part;
  domain.move_to(new_time);
  if (medium.has_grains) {
    carry_grains(medium.cell_void_fraction, domain, old_open_share);
    fill_scalar_ghosts(domain, medium.cell_void_fraction);
    grains.void_fraction = medium.cell_void_fraction;
  }
  fill_fresh_cells(pressure, domain, old_open_share);
  follow_walls(took_part);
  fill_velocity_ghosts(domain, medium, velocity);
  momentum = gas_momentum(domain, medium, velocity);
  momentum_of_moved_walls += *momentum - momentum_before;
  return true;
}

// What the parts of the step know of the walls of the domain.
void GasSolver::State::follow_walls(const VectorField& took_part) {
  cfd::find_walls(medium, domain);
  if (medium.has_grains) update(medium.edges, domain, medium.cell_void_fraction);
  immersed_boundary = ImmersedBoundary(domain);
  loads.find_walls();
  projection.follow_walls(pressure, took_part);
}

void GasSolver::State::evaluate_slope() {
  std::swap(slope, old_slope);
  if (domain.has_motion) {  // the volumes of faces have changed
    old_slope.convection = volume_integral(domain, old_slope.total) - old_slope.viscous;
  }
  const Convection scheme = gas_case.numerics.convection;
  slope.convection = slope.viscous = Vec3::Zero();
  for (int d = 0; d < 3; ++d) {
    if (!domain.solved[d]) continue;
    Field& total = slope.total[d];
    const auto integral = [&, volume = domain.control_volume[d].data(),
                           value = total.data()](const IndexBox& box) {
      return sum_box(box, total, [=](std::ptrdiff_t n) { return volume[n] * value[n]; });
    };
    for_each_part(all_faces(domain, d), [&](const IndexBox& part) {
      for_box(part, total, [value = total.data()](std::ptrdiff_t n) { value[n] = 0.0; });
      add_convection(total, domain, part, medium, velocity, scheme, d);
      const double convection = integral(part);
      slope.convection[d] += convection;
      if (domain.gas.viscosity == 0.0) return;
      add_viscous_stress(total, domain, part, medium, velocity, d);
      slope.viscous[d] += integral(part) - convection;
    });
    slope.convection[d] += add_convection_on_sides(total, domain, medium, velocity, scheme, d);
  }
}

// Steps 1 and 2 on the faces that take part.
void GasSolver::State::predict(double dt, const AdamsBashforth& weights) {
  const double rho = domain.gas.density;
  for (int d = 0; d < 3; ++d) {
    if (!domain.solved[d]) continue;
    const double g = domain.gas.gravity[d] - driving.value()[d] / rho;
    const double* part = domain.walls.takes_part[d].data();
    const double* now = slope.total[d].data();
    const double* before = old_slope.total[d].data();
    const double* eps = medium.void_fraction[d].data();
    const double* b = medium.momentum_exchange[d].data();
    const double* bv = medium.exchange_momentum[d].data();
    double* u = velocity[d].data();
    if (medium.has_grains) {
      for_box(all_faces(domain, d), velocity[d], [=](std::ptrdiff_t n) {
        const double mass = eps[n] * rho;
        const double force = weights.now * now[n] + weights.before * before[n] + bv[n];
        const double predicted = (mass * (u[n] + dt * g) + dt * force) / (mass + dt * b[n]);
        u[n] = part[n] != 0.0 ? predicted : u[n];
      });
    } else {
      for_box(all_faces(domain, d), velocity[d], [=](std::ptrdiff_t n) {
        const double force = weights.now * now[n] + weights.before * before[n];
        u[n] = part[n] != 0.0 ? u[n] + dt * (force / rho + g) : u[n];
      });
    }
  }
}

void GasSolver::State::take_stage(StepReport& report, PassClock& clock, double dt,
                                  const AdamsBashforth& weights, const Field* void_before) {
  const double speed_before = speeds.maxCoeff();
  predict(dt, weights);
  clock.finish(report.times, Pass::predict);
  set_solid_faces(velocity, domain);
  fill_velocity_ghosts(domain, medium, velocity);
  if (domain.walls.has_bodies) {
    report.momentum.body = domain.walls.spans_bodies
                               ? volume_forcing.apply(velocity, domain, medium, dt)
                               : immersed_boundary.apply(velocity, domain, medium, dt);
    fill_velocity_ghosts(domain, medium, velocity);
  }
  if (driving.present()) {
    driving.keep_mean_flow(velocity, medium, dt);
    fill_velocity_ghosts(domain, medium, velocity);
  }
  check_finite(dt, speed_before);
  clock.finish(report.times, Pass::boundary);
  const Projection::Balance balance = projection.set_equation(medium, void_before, velocity, dt);
  report.removed_mean = balance.removed_mean;
  report.swept_imbalance = balance.swept_imbalance;
  clock.finish(report.times, Pass::equation);
  report.pressure = projection.solve(pressure);
  clock.finish(report.times, Pass::solve);
  projection.correct(velocity, pressure, medium, dt);
  if (domain.walls.spans_bodies) {
    report.momentum.body +=
        volume_forcing.add_pressure(projection.pressure_gradient(), domain, medium, dt);
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
  budget.body_stress = -loads.stress_impulse();
  loads.add_pressure(pressure, projection.pressure_gradient(), driving.value(), dt);
  loads.finish(dt);
}

void GasSolver::State::check_finite(double dt, double speed_before) const {
  double sum = 0.0;
  for (int d = 0; d < 3; ++d) {
    sum += sum_box(all_faces(domain, d), velocity[d],
                   [u = velocity[d].data()](std::ptrdiff_t n) { return std::abs(u[n]); });
  }
  if (std::isfinite(sum_over_ranks(domain.decomposition, sum))) return;
  std::ostringstream message;
  message << "the gas velocity is no longer finite at t = " << time << " s after a step of " << dt
          << " s; the largest velocity before it was " << speed_before
          << " m/s. Take a smaller step, or look for grains or inlets that drive it";
  throw SolveFailure(message.str());
}

void GasSolver::State::visit(StateArchive& archive) {
  archive.number("time", time);
  archive.number("previous_dt", previous_dt);
  archive.number("body_clock", body_clock);
  double walls_time = domain.walls_time;
  archive.number("walls_time", walls_time);
  if (archive.restores() && domain.has_motion) {
    domain.move_to(walls_time);
    follow_walls(domain.walls.takes_part);
  }
  archive.faces("velocity", velocity);
  archive.cells("pressure", pressure);  // the first guess of the next solve
  archive.faces("slope", slope.total);
  archive.partial_sums("slope_convection", {slope.convection.data(), 3});
  archive.partial_sums("slope_viscous", {slope.viscous.data(), 3});
  if (driving.present()) {
    driving.visit([&](const std::string& name, double& value) { archive.number(name, value); });
  }
  visit_grains(archive);
  if (archive.restores()) rebuild();
}

void GasSolver::State::visit_grains(StateArchive& archive) {
  bool present = medium.has_grains;
  archive.number_of("has_grains", present);
  if (archive.restores() && !present) grains = no_grains(domain.size());
  if (!present) return;
  archive.cells("void_fraction", grains.void_fraction);
  archive.cells("momentum_exchange", grains.momentum_exchange);
  for (int d = 0; d < 3; ++d) {
    archive.cells(std::string("exchange_momentum_") + "xyz"[d], grains.exchange_momentum[d]);
  }
}

// What follows from the state that was restored.
void GasSolver::State::rebuild() {
  domain.sides.set_time(time);
  update(medium, domain, grains);
  fill_velocity_ghosts(domain, medium, velocity);
  fill_ghosts(domain.decomposition, pressure);
  momentum.reset();
  projection.restore(pressure);
  if (driving.present()) driving.add_to(projection.pressure_gradient());
  speeds = largest_speeds(domain, velocity);
}

GasSolver::GasSolver(const GasCase& gas_case, MPI_Comm communicator)
    : state_(std::make_unique<State>(gas_case, communicator)) {}

GasSolver::~GasSolver() = default;

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
  s.check_finite(dt, s.speeds.maxCoeff());

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
  budget.viscous = dt * (weights.now * s.slope.viscous + weights.before * s.old_slope.viscous);
  if (domain.walls.has_bodies) s.measure_loads(budget, dt, weights);
  s.momentum =
      add_forces(budget, domain, s.medium, s.velocity, s.projection.pressure_gradient(), dt);
  budget.stored = *s.momentum - momentum_before;
  add_pressure_reactions(budget, domain, s.pressure, s.projection.pressure_gradient(),
                         s.driving.value(), dt);
  sum_over_ranks(domain.decomposition, budget);
  clock.finish(report.times, Pass::budget);
  if (s.means.started()) s.means.add(s.medium, s.velocity, s.projection.pressure_gradient(), dt);
  return report;
}

void GasSolver::set_velocity(const std::function<Vec3(const Vec3&)>& velocity) {
  state_->set_velocity(velocity);
}

const GasCase& GasSolver::gas_case() const {
  return state_->gas_case;
}
const Decomposition& GasSolver::decomposition() const {
  return state_->domain.decomposition;
}
const WallGeometry& GasSolver::walls() const {
  return state_->domain.walls;
}
const std::vector<SidePart>& GasSolver::side_parts() const {
  return state_->domain.sides.parts();
}
GrainPhase& GasSolver::grains() {
  return state_->grains;
}
const std::vector<BodyLoad>& GasSolver::body_loads() const {
  return state_->loads.loads();
}
double GasSolver::time() const {
  return state_->time;
}
const VectorField& GasSolver::velocity() const {
  return state_->velocity;
}
const Field& GasSolver::pressure() const {
  return state_->pressure;
}
const Field& GasSolver::void_fraction() const {
  return state_->medium.cell_void_fraction;
}

void GasSolver::set_body_clock(double clock) {
  State& s = *state_;
  s.body_clock = clock;
  if (!s.domain.has_motion) return;
  s.domain.move_to(clock);
  s.follow_walls(s.domain.walls.takes_part);
  set_solid_faces(s.velocity, s.domain);
  fill_velocity_ghosts(s.domain, s.medium, s.velocity);
  s.speeds = largest_speeds(s.domain, s.velocity);
}

bool GasSolver::move_bodies(double time) {
  return state_->move_bodies(state_->body_clock + time);
}

void GasSolver::visit_state(StateArchive& archive) {
  state_->visit(archive);
}

void GasSolver::accept_void_fraction_as_old() {
  update(state_->medium, state_->domain, state_->grains);
  fill_velocity_ghosts(state_->domain, state_->medium, state_->velocity);
  state_->momentum.reset();
}

double GasSolver::largest_stable_step() const {
  return step_limits().smallest();
}

void GasSolver::State::sample(VectorField& velocity_at_cells, VectorField& gradient_at_cells,
                              const VectorField& u, const VectorField& gradient) const {
  IndexBox cells{{0, 0, 0}, domain.size()};
  for (int d = 0; d < 3 && domain.any_lenders; ++d) {  // hosts of lenders are also first ghosts
    if (!domain.decomposition.at_boundary(d, 0)) cells.begin[d] -= 1;
    if (!domain.decomposition.at_boundary(d, 1)) cells.end[d] += 1;
  }
  for (int d = 0; d < 3; ++d) {
    for (VectorField* result : {&velocity_at_cells, &gradient_at_cells}) {
      if ((*result)[d].size() != domain.size()) (*result)[d] = Field(domain.size());
    }
    const std::ptrdiff_t s = u[d].stride(d);
    const double* lower = domain.walls.lower_share[d].data();
    const double* upper = domain.walls.upper_share[d].data();
    for_box(cells, u[d], [=, u = u[d].data(), result = velocity_at_cells[d].data()](auto n) {
      const bool free = lower[n] + upper[n] > 0.0;
      const double mean = lower[n] * u[n] + upper[n] * u[n + s];
      result[n] = free ? mean : 0.5 * (u[n] + u[n + s]);
    });
    for_box(cells, u[d], [=, g = gradient[d].data(), result = gradient_at_cells[d].data()](auto n) {
      result[n] = lower[n] * g[n] + upper[n] * g[n + s];
    });
    for (const Lender& lender : domain.lenders[d]) {
      velocity_at_cells[d][lender.cell] = velocity_at_cells[d][lender.host];
      gradient_at_cells[d][lender.cell] = gradient_at_cells[d][lender.host];
    }
  }
  Field* const results[] = {&velocity_at_cells[0], &velocity_at_cells[1], &velocity_at_cells[2],
                            &gradient_at_cells[0], &gradient_at_cells[1], &gradient_at_cells[2]};
  fill_ghosts(domain.decomposition, results);
}

StepLimits GasSolver::step_limits() const {
  const GasProperties& gas = state_->domain.gas;
  return cfd::step_limits(state_->domain, state_->speeds,
                          gas.gravity - state_->driving.value() / gas.density,
                          state_->gas_case.numerics);
}

void GasSolver::sample_at_cells(VectorField& velocity, VectorField& pressure_gradient) const {
  state_->sample(velocity, pressure_gradient, state_->velocity,
                 state_->projection.pressure_gradient());
}

void GasSolver::start_means() {
  state_->means.start(state_->domain.size());
}

void GasSolver::sample_means_at_cells(VectorField& velocity, VectorField& pressure_gradient) {
  IntervalMeans& means = state_->means;
  means.finish(state_->medium);
  state_->sample(velocity, pressure_gradient, means.velocity(), means.pressure_gradient());
}

double GasSolver::side_pressure(int direction, int side) const {
  const GasDomain& domain = state_->domain;
  GASGRAIN_ASSERT(!domain.is_periodic(direction));
  const double force = sum_over_ranks(
      domain.decomposition, side_force(domain, state_->pressure,
                                       state_->projection.pressure_gradient(), direction, side));
  const double area = side_open_area(direction, side);
  return area > 0.0 ? force / area : 0.0;
}

double GasSolver::side_open_area(int direction, int side) const {
  const GasDomain& domain = state_->domain;
  return sum_over_ranks(domain.decomposition, cfd::side_open_area(domain, direction, side));
}

double GasSolver::side_flux(int direction, int side) const {
  const int cells = decomposition().grid().cells[direction];
  return sum_over_ranks(decomposition(), plane_flux(direction, side == 0 ? 0 : cells));
}

double GasSolver::plane_flux(int direction, int plane) const {
  const GasDomain& domain = state_->domain;
  const Index3& cells = domain.decomposition.grid().cells;
  const bool joined = domain.is_periodic(direction) && plane == cells[direction];
  const int local = (joined ? 0 : plane) - domain.decomposition.block().lower[direction];
  if (local < 0 || local >= owned_faces(domain.decomposition, direction)[direction]) return 0.0;
  double flux = 0.0;
  for_each_in(plane_of(domain, direction, local), [&](int i, int j, int k) {
    const std::ptrdiff_t n = domain.open_share.index(i, j, k);
    flux += domain.walls.open_area[direction][n] *
            face_void_fraction(state_->medium, direction, n) * state_->velocity[direction][n] *
            domain.face_area(direction);
  });
  return flux;
}

}  // namespace gasgrain::cfd
