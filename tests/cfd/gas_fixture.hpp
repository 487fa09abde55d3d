// Small gas cases that several tests start from.
#pragma once

#include <cmath>
#include <string>

#include "cfd/gas_solver.hpp"
#include "cfd/halo_exchange.hpp"
#include "cfd/loops.hpp"
#include "coupling/shared/body.hpp"

namespace gasgrain::cfd::testing {

inline Boundary side(BoundaryType type) {
  Boundary boundary;
  boundary.type = type;
  return boundary;
}

inline Boundary inlet(const Vec3& superficial_velocity) {
  Boundary boundary = side(BoundaryType::inlet);
  boundary.superficial_velocity = superficial_velocity;
  return boundary;
}

// A box of gas of density and viscosity 1 with no-slip sides.
inline GasCase box_case(const Vec3& upper, const Index3& cells) {
  GasCase result;
  result.grid.lower = Vec3::Zero();
  result.grid.upper = upper;
  result.grid.cells = cells;
  result.gas = {.density = 1.0, .viscosity = 1.0, .gravity = Vec3::Zero()};
  result.numerics.pressure_tolerance = 1e-10;
  return result;
}

inline void set_sides(GasCase& gas_case, int direction, BoundaryType type) {
  gas_case.boundaries[direction][0] = gas_case.boundaries[direction][1] = side(type);
}

// Bodies from the text of [[body]] tables.
inline std::vector<Body> bodies(const std::string& toml) {
  return read_bodies(ConfigTable::parse(toml, "test.toml"), nullptr);
}

inline Vec3 cell_centre(const Decomposition& blocks, int i, int j, int k) {
  const Index3& lower = blocks.block().lower;
  const Vec3 steps(i + lower[0] + 0.5, j + lower[1] + 0.5, k + lower[2] + 0.5);
  return blocks.grid().lower + steps.cwiseProduct(blocks.grid().spacing());
}

// Sum of the rows that must make up the change of momentum, minus that change.
inline Vec3 imbalance(const MomentumBudget& m) {
  return m.pressure + m.gravity + m.convection + m.viscous + m.drag + m.body - m.stored;
}

inline Vec3 pressure_imbalance(const MomentumBudget& m) {
  return m.pressure + m.pressure_on_grains - m.side_pressure - m.body_pressure;
}

// Sum of the magnitudes of all rows.
inline double turnover(const MomentumBudget& m) {
  double sum = 0.0;
  for (const Vec3& row : {m.stored, m.pressure, m.pressure_on_grains, m.gravity, m.convection,
                          m.viscous, m.drag, m.body}) {
    sum += row.norm();
  }
  return sum;
}

// Grains as a smooth heap whose centre wanders with `phase`; the solid volume never changes.
inline void set_moving_heap(GasSolver& solver, double phase, double mean_solid, double exchange) {
  const Decomposition& blocks = solver.decomposition();
  const Grid& grid = blocks.grid();
  Field shape(blocks.block().size);
  long double own_sum = 0.0, own_volume = 0.0;  // exact enough for sealed vessels of many cells
  for_each_cell(shape.size(), [&](int i, int j, int k) {
    const Vec3 x =
        (cell_centre(blocks, i, j, k) - grid.lower).cwiseQuotient(grid.upper - grid.lower);
    const Vec3 centre(0.5 + 0.2 * std::sin(phase), 0.5, 0.4 + 0.15 * std::cos(1.3 * phase));
    shape(i, j, k) = 0.2 + std::exp(-8.0 * (x - centre).squaredNorm());
    const double open = 1.0 - solver.walls().wall_fraction(i, j, k);
    own_sum += open * shape(i, j, k);
    own_volume += open;
  });
  const double sum = sum_over_ranks(blocks, static_cast<double>(own_sum));
  const double volume = sum_over_ranks(blocks, static_cast<double>(own_volume));
  GrainPhase& grains = solver.grains();
  for_each_cell(shape.size(), [&](int i, int j, int k) {
    const double solid = mean_solid * volume / sum * shape(i, j, k);
    grains.void_fraction(i, j, k) = 1.0 - solid;
    grains.momentum_exchange(i, j, k) = exchange * solid;
    const Vec3 velocity(0.3 * std::cos(phase), 0.1, -0.2 * std::sin(1.3 * phase));
    for (int d = 0; d < 3; ++d) {
      grains.exchange_momentum[d](i, j, k) = exchange * solid * velocity[d];
    }
  });
}

}  // namespace gasgrain::cfd::testing
