// The final velocity of a face satisfies, with V its control volume,
//
//   V eps rho (u - u_n) = dt V ( slope + eps rho g + B (v - u) - eps grad p ) + body,
//
// where `body` is V eps rho (1 + K) times the change of u* by the immersed boundary. Every row is
// the sum of one of these terms, so the rows add up to the change of momentum up to round-off.
//
// The pressure rows are checked from the other end by summation by parts: the sum of V grad p over
// faces is a sum over cells of p times the difference of the control volumes of their two faces.
// Without bodies only the cells next to the sides have such a difference.
#include "cfd/momentum_budget.hpp"

#include "cfd/halo_exchange.hpp"

namespace gasgrain::cfd {

namespace {

// Area of a cell's face on a side that no body covers.
double open_side_area(const GasDomain& domain, int d, std::ptrdiff_t cell, std::ptrdiff_t face,
                      const SideCondition& condition) {
  const BoundaryType type = condition.type;
  const bool flows = type == BoundaryType::inlet || type == BoundaryType::outlet;
  return domain.face_area(d) * (flows ? domain.walls.open_area[d][face] : domain.open_share[cell]);
}

double pressure_on_side(const GasDomain& domain, const Field& pressure, const Field& gradient,
                        int d, std::ptrdiff_t cell, std::ptrdiff_t face,
                        const SideCondition& condition) {
  if (condition.type == BoundaryType::outlet) return condition.pressure;
  const double half = 0.5 * domain.spacing[d];
  return cell == face ? pressure[cell] - half * gradient[cell + pressure.stride(d)]
                      : pressure[cell] + half * gradient[cell];
}

// sum over faces of V grad p along d, from the cells and the outlets.
double integral_by_parts(const GasDomain& domain, const Field& pressure, int d) {
  const Field& volume = domain.control_volume[d];
  const std::ptrdiff_t s = volume.stride(d);
  double sum = 0.0;
  for_each_cell(domain.size(), [&](int i, int j, int k) {
    const std::ptrdiff_t n = volume.index(i, j, k);
    sum += pressure[n] * (volume[n] - volume[n + s]) / domain.spacing[d];
  });
  for (int side = 0; side < 2; ++side) {
    const double outwards = side == 0 ? -1.0 : 1.0;
    // half the spacing: the cell's coefficient doubles, and the outlet's pressure stands opposite
    for_each_outlet_face(domain, d, side,
                         [&](auto cell, auto face, const SideCondition& condition) {
                           const double weight = outwards * volume[face] / domain.spacing[d];
                           sum += weight * (2.0 * condition.pressure - pressure[cell]);
                         });
  }
  return sum;
}

}  // namespace

Vec3 gas_momentum(const GasDomain& domain, const FaceMedium& medium, const VectorField& velocity) {
  Vec3 momentum = Vec3::Zero();
  for (int d = 0; d < 3; ++d) {
    for_each_face(domain.decomposition, d, [&](int i, int j, int k) {
      const std::ptrdiff_t n = velocity[d].index(i, j, k);
      momentum[d] += domain.control_volume[d][n] * domain.gas.density *
                     face_void_fraction(medium, d, n) * velocity[d][n];
    });
  }
  return momentum;
}

Vec3 volume_integral(const GasDomain& domain, const VectorField& field) {
  Vec3 sum = Vec3::Zero();
  for (int d = 0; d < 3; ++d) {
    for_each_face(domain.decomposition, d, [&](int i, int j, int k) {
      sum[d] += domain.control_volume[d](i, j, k) * field[d](i, j, k);
    });
  }
  return sum;
}

void add_forces(MomentumBudget& budget, const GasDomain& domain, const FaceMedium& medium,
                const VectorField& velocity, const VectorField& pressure_gradient, double dt) {
  for (int d = 0; d < 3; ++d) {
    for_each_face(domain.decomposition, d, [&](int i, int j, int k) {
      const std::ptrdiff_t n = velocity[d].index(i, j, k);
      const double impulse = dt * domain.control_volume[d][n];
      const double eps = face_void_fraction(medium, d, n);
      budget.gravity[d] += impulse * eps * domain.gas.density * domain.gas.gravity[d];
      budget.pressure[d] -= impulse * eps * pressure_gradient[d][n];
      if (!medium.has_grains) return;
      budget.pressure_on_grains[d] -= impulse * (1.0 - eps) * pressure_gradient[d][n];
      budget.drag[d] += impulse * (medium.exchange_momentum[d][n] -
                                   medium.momentum_exchange[d][n] * velocity[d][n]);
    });
  }
}

double side_force(const GasDomain& domain, const Field& pressure,
                  const VectorField& pressure_gradient, int direction, int side) {
  double force = 0.0;
  const Field& gradient = pressure_gradient[direction];
  for_each_side_face(
      domain, direction, side, [&](auto cell, auto face, const SideCondition& condition) {
        force += open_side_area(domain, direction, cell, face, condition) *
                 pressure_on_side(domain, pressure, gradient, direction, cell, face, condition);
      });
  return force;
}

double side_open_area(const GasDomain& domain, int direction, int side) {
  double area = 0.0;
  for_each_side_face(domain, direction, side,
                     [&](auto cell, auto face, const SideCondition& condition) {
                       area += open_side_area(domain, direction, cell, face, condition);
                     });
  return area;
}

void add_pressure_reactions(MomentumBudget& budget, const GasDomain& domain, const Field& pressure,
                            const VectorField& pressure_gradient, double dt) {
  for (int d = 0; d < 3; ++d) {
    if (!domain.solved[d]) continue;
    const double sides = side_force(domain, pressure, pressure_gradient, d, 0) -
                         side_force(domain, pressure, pressure_gradient, d, 1);
    budget.side_pressure[d] += dt * sides;
    budget.body_pressure[d] -= dt * (integral_by_parts(domain, pressure, d) + sides);
  }
}

void sum_over_ranks(const Decomposition& decomposition, MomentumBudget& budget) {
  Vec3* const rows[] = {&budget.stored,        &budget.pressure,   &budget.pressure_on_grains,
                        &budget.gravity,       &budget.convection, &budget.viscous,
                        &budget.drag,          &budget.body,       &budget.side_pressure,
                        &budget.body_pressure, &budget.body_stress};
  std::vector<double> values;
  for (const Vec3* row : rows) values.insert(values.end(), row->data(), row->data() + 3);
  sum_over_ranks(decomposition, values);
  auto next = values.begin();
  for (Vec3* row : rows) {
    for (int d = 0; d < 3; ++d) (*row)[d] = *next++;
  }
}

}  // namespace gasgrain::cfd
