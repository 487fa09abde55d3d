// Construction, moving walls, and what a restart needs.
#include "cfd/gas_state.hpp"

#include <utility>

#include "cfd/boundary_checks.hpp"
#include "cfd/ghost_values.hpp"
#include "cfd/halo_exchange.hpp"
#include "cfd/momentum_budget.hpp"
#include "cfd/moving_walls.hpp"
#include "coupling/shared/error.hpp"

namespace gasgrain::cfd {

namespace {

VectorField fields(const Index3& size) {
  return {Field(size), Field(size), Field(size)};
}

GrainPhase no_grains(const Index3& size) {
  return {Field(size, 1.0), Field(size), fields(size)};
}

}  // namespace

GasSolver::State::State(const GasCase& given, MPI_Comm communicator)
    : gas_case(given),
      domain(given, communicator),
      medium(make_face_medium(domain)),
      grains(no_grains(domain.size())),
      immersed_boundary(domain),
      volume_forcing(domain),
      loads(domain),
      uneven_cells(find_uneven_cells(domain)),
      projection(domain, given.numerics),
      driving(domain),
      felt(domain),
      velocity(fields(domain.size())),
      pressure(domain.size()),
      slope_evaluation(domain, given.numerics.convection) {
  slope.total = old_slope.total = fields(domain.size());
  if (given.numerics.viscosity == Viscosity::implicit_step && domain.gas.viscosity > 0.0) {
    GASGRAIN_ASSERT(given.numerics.time_scheme == TimeScheme::ab2 && !domain.walls.spans_bodies);
    implicit_viscosity.emplace(domain);
    slope.stress = old_slope.stress = forces = fields(domain.size());
    medium.has_scaling = domain.walls.has_bodies;
    if (medium.has_scaling) {
      for (Field& scaling : medium.density_scaling) scaling = Field(domain.size(), 1.0);
    }
  }
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
  steps_from_start = 0;
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
  uneven_cells = find_uneven_cells(domain);
  projection.follow_walls(pressure, took_part);
  if (driving.present()) driving.add_to(projection.pressure_gradient());
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
  visit_stress(archive);
  archive.partial_sums("slope_convection", {slope.convection.data(), 3});
  archive.partial_sums("slope_viscous", {slope.viscous.data(), 3});
  if (driving.present()) {
    driving.visit([&](const std::string& name, double& value) { archive.number(name, value); });
  }
  visit_grains(archive);
  if (archive.restores()) rebuild();
}

// A run that continues with the other kind of viscosity starts with a step of Euler's.
void GasSolver::State::visit_stress(StateArchive& archive) {
  archive.number_of("steps_from_start", steps_from_start);
  bool apart = implicit_viscosity.has_value();
  archive.number_of("stress_apart", apart);
  if (apart != implicit_viscosity.has_value()) previous_dt = 0.0;
  if (!apart) return;
  VectorField stress = implicit_viscosity ? std::move(slope.stress) : fields(domain.size());
  archive.faces("stress", stress);
  if (implicit_viscosity) slope.stress = std::move(stress);
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
  archive.number("density_ratio", grains.density_ratio);
  if (lag_of(grains.density_ratio) > 0.0) felt.visit_state(archive);
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

void GasSolver::set_velocity(const std::function<Vec3(const Vec3&)>& velocity) {
  state_->set_velocity(velocity);
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

}  // namespace gasgrain::cfd
