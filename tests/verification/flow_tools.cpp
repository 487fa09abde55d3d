#include "tests/verification/flow_tools.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

namespace gasgrain::verification {

namespace {

using cfd::Field;
using cfd::GasSolver;
using cfd::Grid;
using cfd::Index3;

// `offset`: where value (0,0,0) lies, in cells from the lower corner. A direction of one cell does
// not matter.
double interpolated(const Field& field, const Grid& grid, const Vec3& offset, const Vec3& x) {
  const Vec3 steps = (x - grid.lower).cwiseQuotient(grid.spacing()) - offset;
  Index3 base{0, 0, 0};
  Vec3 weight = Vec3::Zero();
  for (int d = 0; d < 3; ++d) {
    if (grid.cells[d] == 1) continue;
    base[d] = std::clamp(static_cast<int>(std::floor(steps[d])), -1, grid.cells[d] - 1);
    weight[d] = steps[d] - base[d];
  }
  double sum = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const Index3 up{corner & 1, corner >> 1 & 1, corner >> 2 & 1};
    double w = 1.0;
    for (int d = 0; d < 3; ++d) w *= up[d] ? weight[d] : 1.0 - weight[d];
    if (w != 0.0) sum += w * field(base[0] + up[0], base[1] + up[1], base[2] + up[2]);
  }
  return sum;
}

double velocity_in(const Field& component, const Grid& grid, int d, const Vec3& x) {
  Vec3 offset = Vec3::Constant(0.5);
  offset[d] = 0.0;
  return interpolated(component, grid, offset, x);
}

// First and last plane of faces of the box per direction.
struct Planes {
  Index3 lower, upper;
};

Planes planes_of(const GasSolver& solver, const Vec3& lower, const Vec3& upper) {
  const Grid& grid = solver.decomposition().grid();
  Planes planes{{0, 0, 0}, {0, 1, 0}};
  for (const int d : {0, 2}) {
    planes.lower[d] = static_cast<int>(std::lround((lower[d] - grid.lower[d]) / grid.spacing()[d]));
    planes.upper[d] = static_cast<int>(std::lround((upper[d] - grid.lower[d]) / grid.spacing()[d]));
  }
  return planes;
}

// Flux of momentum along +n through face f of direction n in the plane of n and t, per area:
// rho u_n u + p n - tau n, with components (n, t).
struct FaceFlux {
  double normal, tangential;
};

FaceFlux momentum_flux(const GasSolver& solver, int n, int t, std::ptrdiff_t f) {
  const Field &u = solver.velocity()[n], &v = solver.velocity()[t], &p = solver.pressure();
  const std::ptrdiff_t a = u.stride(n), b = u.stride(t);
  const Vec3 h = solver.decomposition().grid().spacing();
  const double rho = solver.gas_case().gas.density, mu = solver.gas_case().gas.viscosity;
  const double across = 0.25 * (v[f] + v[f + b] + v[f - a] + v[f - a + b]);
  const double u_n = 0.5 * (u[f + a] - u[f - a]) / h[n], u_t = 0.5 * (u[f + b] - u[f - b]) / h[t];
  const double v_n = 0.5 * (v[f] + v[f + b] - v[f - a] - v[f - a + b]) / h[n];
  return {rho * u[f] * u[f] + 0.5 * (p[f] + p[f - a]) - 2.0 * mu * u_n,
          rho * u[f] * across - mu * (u_t + v_n)};
}

}  // namespace

double velocity_at(const GasSolver& solver, int d, const Vec3& x) {
  return velocity_in(solver.velocity()[d], solver.decomposition().grid(), d, x);
}

double pressure_at(const GasSolver& solver, const Vec3& x) {
  return interpolated(solver.pressure(), solver.decomposition().grid(), Vec3::Constant(0.5), x);
}

std::function<Vec3(const Vec3&)> sampled_velocity(const GasSolver& solver) {
  const auto velocity = std::make_shared<const cfd::VectorField>(solver.velocity());
  return [velocity, grid = solver.decomposition().grid()](const Vec3& x) {
    Vec3 result;
    for (int d = 0; d < 3; ++d) result[d] = velocity_in((*velocity)[d], grid, d, x);
    return result;
  };
}

void advance_by(GasSolver& solver, double duration) {
  const int steps = static_cast<int>(std::ceil(duration / (0.97 * solver.largest_stable_step())));
  for (int n = 0; n < steps; ++n) solver.advance(duration / steps);
}

int advance_until_steady(GasSolver& solver, double duration, double tolerance, int limit,
                         const std::function<double()>& watched) {
  double before = watched();
  for (int n = 1; n <= limit; ++n) {
    advance_by(solver, duration);
    const double now = watched();
    if (std::abs(now - before) < tolerance * std::abs(now)) return n;
    before = now;
  }
  return limit;
}

Vec3 force_between(const GasSolver& solver, const Vec3& lower, const Vec3& upper) {
  const Planes planes = planes_of(solver, lower, upper);
  const Vec3 h = solver.decomposition().grid().spacing();
  Vec3 force = Vec3::Zero();
  for (const int n : {0, 2}) {
    const int t = 2 - n;
    const double area = h.prod() / h[n];
    for (const int side : {0, 1}) {
      const double sign = side == 0 ? area : -area;
      Index3 face{0, 0, 0};
      face[n] = side == 0 ? planes.lower[n] : planes.upper[n];
      for (face[t] = planes.lower[t]; face[t] < planes.upper[t]; ++face[t]) {
        const std::ptrdiff_t f = solver.pressure().index(face[0], face[1], face[2]);
        const FaceFlux flux = momentum_flux(solver, n, t, f);
        force[n] += sign * flux.normal;
        force[t] += sign * flux.tangential;
      }
    }
  }
  return force;
}

Vec3 momentum_between(const GasSolver& solver, const Vec3& lower, const Vec3& upper) {
  const Planes planes = planes_of(solver, lower, upper);
  const Grid& grid = solver.decomposition().grid();
  const double scale = 0.5 * solver.gas_case().gas.density * grid.cell_volume();
  Vec3 momentum = Vec3::Zero();
  for (int k = planes.lower[2]; k < planes.upper[2]; ++k) {
    for (int i = planes.lower[0]; i < planes.upper[0]; ++i) {
      const std::ptrdiff_t n = solver.pressure().index(i, 0, k);
      for (const int d : {0, 2}) {
        const Field& u = solver.velocity()[d];
        momentum[d] += scale * (u[n] + u[n + u.stride(d)]);
      }
    }
  }
  return momentum;
}

Oscillation oscillation_after(double start, const std::vector<double>& times,
                              const std::vector<double>& values) {
  const auto first =
      static_cast<std::size_t>(std::lower_bound(times.begin(), times.end(), start) - times.begin());
  Oscillation result;
  if (first >= values.size()) return result;
  const auto [low, high] = std::minmax_element(values.begin() + first, values.end());
  result.smallest = *low;
  result.largest = *high;
  const double middle = 0.5 * (*low + *high);
  double first_crossing = 0.0, last_crossing = 0.0, integral = 0.0;
  int crossings = 0;
  for (std::size_t n = first + 1; n < values.size(); ++n) {
    integral += 0.5 * (values[n] + values[n - 1]) * (times[n] - times[n - 1]);
    if (values[n - 1] >= middle || values[n] < middle) continue;
    const double share = (middle - values[n - 1]) / (values[n] - values[n - 1]);
    last_crossing = times[n - 1] + share * (times[n] - times[n - 1]);
    if (crossings++ == 0) first_crossing = last_crossing;
  }
  result.mean = integral / (times.back() - times[first]);
  result.periods = std::max(crossings - 1, 0);
  if (result.periods > 0) result.frequency = result.periods / (last_crossing - first_crossing);
  return result;
}

}  // namespace gasgrain::verification
