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

#include <algorithm>
#include <array>
#include <iterator>

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

// Of one direction.
struct FaceFields {
  const double *volume, *gradient, *eps, *u, *b, *bv;
};

struct FaceSums {
  double gradient_on_all = 0.0, gradient_on_gas = 0.0;  // V grad p, V eps grad p
  double flow = 0.0, gas_volume = 0.0;                  // V eps u, V eps
  double drag = 0.0;                                    // V (B v - B u)
};

void add_row(FaceSums& sums, FaceFields f, std::ptrdiff_t row, int length) {
  double on_all = 0.0, on_gas = 0.0, flow = 0.0, gas_volume = 0.0, drag = 0.0;
#pragma omp simd reduction(+ : on_all, on_gas, flow, gas_volume, drag)
  for (std::ptrdiff_t n = row; n < row + length; ++n) {
    const double gas = f.volume[n] * f.eps[n];
    on_all += f.volume[n] * f.gradient[n];
    on_gas += gas * f.gradient[n];
    flow += gas * f.u[n];
    gas_volume += gas;
    drag += f.volume[n] * (f.bv[n] - f.b[n] * f.u[n]);
  }
  sums.gradient_on_all += on_all;
  sums.gradient_on_gas += on_gas;
  sums.flow += flow;
  sums.gas_volume += gas_volume;
  sums.drag += drag;
}

void add_row_without_grains(FaceSums& sums, FaceFields f, std::ptrdiff_t row, int length) {
  double on_all = 0.0, flow = 0.0, gas_volume = 0.0;
#pragma omp simd reduction(+ : on_all, flow, gas_volume)
  for (std::ptrdiff_t n = row; n < row + length; ++n) {
    on_all += f.volume[n] * f.gradient[n];
    flow += f.volume[n] * f.u[n];
    gas_volume += f.volume[n];
  }
  sums.gradient_on_all += on_all;
  sums.flow += flow;
  sums.gas_volume += gas_volume;
}

// sum over faces of V grad p along d, from the cells and the outlets.
double integral_by_parts(const GasDomain& domain, const UnevenCells& uneven, const Field& pressure,
                         int d) {
  const Field& volume = domain.control_volume[d];
  const std::ptrdiff_t s = volume.stride(d);
  const double* v = volume.data();
  const double* p = pressure.data();
  double sum = 0.0;
  for (const std::ptrdiff_t n : uneven[d]) sum += p[n] * (v[n] - v[n + s]);
  sum /= domain.spacing[d];
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
    const double* volume = domain.control_volume[d].data();
    const double* eps = medium.void_fraction[d].data();
    const double* u = velocity[d].data();
    const IndexBox faces = all_faces(domain, d);
    momentum[d] =
        domain.gas.density *
        (medium.has_grains
             ? sum_box(faces, velocity[d], [=](auto n) { return volume[n] * eps[n] * u[n]; })
             : sum_box(faces, velocity[d], [=](auto n) { return volume[n] * u[n]; }));
  }
  return momentum;
}

Vec3 volume_integral(const GasDomain& domain, const VectorField& field) {
  Vec3 sum = Vec3::Zero();
  for (int d = 0; d < 3; ++d) {
    const double* volume = domain.control_volume[d].data();
    const double* value = field[d].data();
    sum[d] = sum_box(all_faces(domain, d), field[d], [=](auto n) { return volume[n] * value[n]; });
  }
  return sum;
}

Vec3 add_forces(MomentumBudget& budget, const GasDomain& domain, const FaceMedium& medium,
                const VectorField& velocity, const VectorField& pressure_gradient, double dt) {
  Vec3 momentum;
  for (int d = 0; d < 3; ++d) {
    const FaceFields fields{domain.control_volume[d].data(),    pressure_gradient[d].data(),
                            medium.void_fraction[d].data(),     velocity[d].data(),
                            medium.momentum_exchange[d].data(), medium.exchange_momentum[d].data()};
    FaceSums sums;
    for_each_row(all_faces(domain, d), velocity[d], [&](std::ptrdiff_t row, int length) {
      medium.has_grains ? add_row(sums, fields, row, length)
                        : add_row_without_grains(sums, fields, row, length);
    });
    if (!medium.has_grains) sums.gradient_on_gas = sums.gradient_on_all;
    budget.pressure[d] -= dt * sums.gradient_on_gas;
    budget.pressure_on_grains[d] -= dt * (sums.gradient_on_all - sums.gradient_on_gas);
    budget.gravity[d] += dt * domain.gas.density * domain.gas.gravity[d] * sums.gas_volume;
    budget.drag[d] += dt * sums.drag;
    momentum[d] = domain.gas.density * sums.flow;
  }
  return momentum;
}

UnevenCells find_uneven_cells(const GasDomain& domain) {
  UnevenCells uneven;
  for (int d = 0; d < 3; ++d) {
    const Field& volume = domain.control_volume[d];
    for_each_cell(domain.size(), [&](int i, int j, int k) {
      const std::ptrdiff_t n = volume.index(i, j, k);
      if (volume[n] != volume[n + volume.stride(d)]) uneven[d].push_back(n);
    });
  }
  return uneven;
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

void add_pressure_reactions(MomentumBudget& budget, const GasDomain& domain,
                            const UnevenCells& uneven, const Field& pressure,
                            const VectorField& pressure_gradient, const Vec3& uniform_gradient,
                            double dt) {
  for (int d = 0; d < 3; ++d) {
    if (!domain.solved[d]) continue;
    if (uniform_gradient[d] != 0.0) {
      const double all = domain.cell_volume() * domain.size()[0] * domain.size()[1] *
                         static_cast<double>(domain.size()[2]);
      double gas = 0.0;
      for_each_face(domain.decomposition, d,
                    [&](int i, int j, int k) { gas += domain.control_volume[d](i, j, k); });
      budget.side_pressure[d] -= dt * uniform_gradient[d] * all;
      budget.body_pressure[d] += dt * uniform_gradient[d] * (all - gas);
    }
    const double sides = side_force(domain, pressure, pressure_gradient, d, 0) -
                         side_force(domain, pressure, pressure_gradient, d, 1);
    budget.side_pressure[d] += dt * sides;
    budget.body_pressure[d] -= dt * (integral_by_parts(domain, uneven, pressure, d) + sides);
  }
}

void sum_over_ranks(const Decomposition& decomposition, MomentumBudget& budget) {
  Vec3* const rows[] = {&budget.stored,        &budget.pressure,   &budget.pressure_on_grains,
                        &budget.gravity,       &budget.convection, &budget.viscous,
                        &budget.drag,          &budget.body,       &budget.side_pressure,
                        &budget.body_pressure, &budget.body_stress};
  std::array<double, 3 * std::size(rows)> values;
  auto next = values.begin();
  for (const Vec3* row : rows) next = std::copy_n(row->data(), 3, next);
  sum_over_ranks(decomposition, values);
  next = values.begin();
  for (Vec3* row : rows) {
    for (int d = 0; d < 3; ++d) (*row)[d] = *next++;
  }
}

}  // namespace gasgrain::cfd
