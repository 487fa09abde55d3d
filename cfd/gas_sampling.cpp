// What others read from a GasSolver: its fields, the gas as grains see it, fluxes and pressures of
// sides.
#include "cfd/gas_state.hpp"
#include "cfd/halo_exchange.hpp"
#include "cfd/momentum_budget.hpp"
#include "cfd/viscous_stress.hpp"
#include "coupling/shared/error.hpp"

namespace gasgrain::cfd {

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
bool GasSolver::has_motion() const {
  return state_->domain.has_motion;
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

namespace {

IndexBox sampled_cells(const GasDomain& domain) {
  IndexBox cells{{0, 0, 0}, domain.size()};
  for (int d = 0; d < 3 && domain.any_lenders; ++d) {  // hosts of lenders are also first ghosts
    if (!domain.decomposition.at_boundary(d, 0)) cells.begin[d] -= 1;
    if (!domain.decomposition.at_boundary(d, 1)) cells.end[d] += 1;
  }
  return cells;
}

// A force per volume, of direction d: what the faces give to their cells when cell values are
// spread to faces with the same shares.
void sample_force(Field& at_cells, const GasDomain& domain, const Field& at_faces, int d) {
  for_box(sampled_cells(domain), at_faces,
          [s = at_faces.stride(d), lower = domain.walls.lower_share[d].data(),
           upper = domain.walls.upper_share[d].data(), f = at_faces.data(),
           result = at_cells.data()](std::ptrdiff_t n) {
            result[n] = lower[n] * f[n] + upper[n] * f[n + s];
          });
  for (const Lender& lender : domain.lenders[d]) at_cells[lender.cell] = at_cells[lender.host];
}

}  // namespace

void GasSolver::State::sample(VectorField& velocity_at_cells, VectorField& gradient_at_cells,
                              const VectorField& u, const VectorField& gradient) const {
  for (int d = 0; d < 3; ++d) {
    for (VectorField* result : {&velocity_at_cells, &gradient_at_cells}) {
      if ((*result)[d].size() != domain.size()) (*result)[d] = Field(domain.size());
    }
    const std::ptrdiff_t s = u[d].stride(d);
    const double* lower = domain.walls.lower_share[d].data();
    const double* upper = domain.walls.upper_share[d].data();
    for_box(sampled_cells(domain), u[d],
            [=, u = u[d].data(), result = velocity_at_cells[d].data()](auto n) {
              const bool free = lower[n] + upper[n] > 0.0;
              const double mean = lower[n] * u[n] + upper[n] * u[n + s];
              result[n] = free ? mean : 0.5 * (u[n] + u[n + s]);
            });
    for (const Lender& lender : domain.lenders[d])
      velocity_at_cells[d][lender.cell] = velocity_at_cells[d][lender.host];
    sample_force(gradient_at_cells[d], domain, gradient[d], d);
  }
  Field* const results[] = {&velocity_at_cells[0], &velocity_at_cells[1], &velocity_at_cells[2],
                            &gradient_at_cells[0], &gradient_at_cells[1], &gradient_at_cells[2]};
  fill_ghosts(domain.decomposition, results);
}

void GasSolver::sample_at_cells(VectorField& velocity, VectorField& pressure_gradient) const {
  state_->sample(velocity, pressure_gradient, state_->velocity, state_->felt_gradient());
}

void GasSolver::sample_viscous_force_at_cells(VectorField& force) const {
  const GasDomain& domain = state_->domain;
  VectorField at_faces;
  for (int d = 0; d < 3; ++d) {
    at_faces[d] = Field(domain.size());
    if (force[d].size() != domain.size()) force[d] = Field(domain.size());
    if (!domain.solved[d]) continue;
    const IndexBox faces = all_faces(domain, d);
    add_viscous_stress(at_faces[d], domain, faces, state_->medium, state_->velocity, d);
    for_box(faces, at_faces[d],
            [f = at_faces[d].data(), part = domain.walls.takes_part[d].data()](std::ptrdiff_t n) {
              f[n] *= part[n];
            });
  }
  fill_ghosts(domain.decomposition, at_faces);
  for (int d = 0; d < 3; ++d) sample_force(force[d], domain, at_faces[d], d);
  fill_ghosts(domain.decomposition, force);
}

void GasSolver::start_means(const Field& void_fraction_at_end) {
  State& s = *state_;
  divide_interval(s.medium, s.domain, void_fraction_at_end);
  s.means.start(s.domain.size());
}

void GasSolver::sample_means_at_cells(VectorField& velocity, VectorField& pressure_gradient) {
  State& s = *state_;
  s.means.finish();
  s.medium.is_divided = false;
  if (s.medium.lag > 0.0) s.felt.finish_interval(s.means.pressure_gradient());
  s.sample(velocity, pressure_gradient, s.means.velocity(), s.means.pressure_gradient());
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
