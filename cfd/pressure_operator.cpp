#include "cfd/pressure_operator.hpp"

#include <cmath>
#include <limits>

#include "cfd/halo_exchange.hpp"
#include "cfd/loops.hpp"

namespace gasgrain::cfd {

namespace {

// The seven-point stencil on raw storage, so that rows vectorize.
struct Stencil {
  const double* diagonal;
  const double* x;
  const double* y;
  const double* z;
  std::ptrdiff_t sy, sz;

  explicit Stencil(const PressureSystem& system)
      : diagonal(system.diagonal.data()),
        x(system.transmissibility[0].data()),
        y(system.transmissibility[1].data()),
        z(system.transmissibility[2].data()),
        sy(system.diagonal.stride(1)),
        sz(system.diagonal.stride(2)) {}

  double apply(const double* p, std::ptrdiff_t n) const {
    return diagonal[n] * p[n] + x[n] * (p[n] - p[n - 1]) + x[n + 1] * (p[n] - p[n + 1]) +
           y[n] * (p[n] - p[n - sy]) + y[n + sy] * (p[n] - p[n + sy]) + z[n] * (p[n] - p[n - sz]) +
           z[n + sz] * (p[n] - p[n + sz]);
  }
  double sum(std::ptrdiff_t n) const {
    return diagonal[n] + x[n] + x[n + 1] + y[n] + y[n + sy] + z[n] + z[n + sz];
  }
  double sum_of_magnitudes(const double* p, std::ptrdiff_t n) const {
    return sum(n) * std::abs(p[n]) + x[n] * std::abs(p[n - 1]) + x[n + 1] * std::abs(p[n + 1]) +
           y[n] * std::abs(p[n - sy]) + y[n + sy] * std::abs(p[n + sy]) +
           z[n] * std::abs(p[n - sz]) + z[n + sz] * std::abs(p[n + sz]);
  }
};

double norm(const Decomposition& decomposition, double sum_of_squares) {
  return std::sqrt(sum_over_ranks(decomposition, sum_of_squares));
}

}  // namespace

double apply(Field& image, const PressureSystem& system, const Field& field) {
  const Stencil a(system);
  const double* x = field.data();
  double* y = image.data();
  return sum_cells(field, [=](std::ptrdiff_t n) {
    y[n] = a.apply(x, n);
    return x[n] * y[n];
  });
}

double residual_norm(const Decomposition& decomposition, const PressureSystem& system,
                     Field& pressure) {
  fill_ghosts(decomposition, pressure);
  const Stencil a(system);
  const double* p = pressure.data();
  const double* b = system.right_hand_side.data();
  return norm(decomposition, sum_cells(pressure, [=](std::ptrdiff_t n) {
                const double residual = b[n] - a.apply(p, n);
                return residual * residual;
              }));
}

double right_hand_side_norm(const Decomposition& decomposition, const PressureSystem& system) {
  const double* b = system.right_hand_side.data();
  return norm(decomposition,
              sum_cells(system.right_hand_side, [=](std::ptrdiff_t n) { return b[n] * b[n]; }));
}

double residual_round_off(const Decomposition& decomposition, const PressureSystem& system,
                          const Field& pressure) {
  const Stencil a(system);
  const double* p = pressure.data();
  const double squares = sum_cells(pressure, [=](std::ptrdiff_t n) {
    const double sum = a.sum_of_magnitudes(p, n);
    return sum * sum;
  });
  return std::numeric_limits<double>::epsilon() * norm(decomposition, squares);
}

void clear_isolated_cells(Field& pressure, const PressureSystem& system) {
  const Stencil a(system);
  double* p = pressure.data();
  for_cells(pressure, [=](std::ptrdiff_t n) { p[n] = a.sum(n) > 0.0 ? p[n] : 0.0; });
}

}  // namespace gasgrain::cfd
