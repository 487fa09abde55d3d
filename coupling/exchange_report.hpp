// What one exchange between gas and grains did, in numbers.
#pragma once

#include <array>

#include "cfd/gas_solver.hpp"
#include "coupling/coupling_interval.hpp"

namespace gasgrain::coupling {

using MomentumRow = Vec3 cfd::MomentumBudget::*;
inline constexpr std::array<MomentumRow, 11> momentum_rows = {
    &cfd::MomentumBudget::stored,
    &cfd::MomentumBudget::pressure,
    &cfd::MomentumBudget::pressure_on_grains,
    &cfd::MomentumBudget::gravity,
    &cfd::MomentumBudget::convection,
    &cfd::MomentumBudget::viscous,
    &cfd::MomentumBudget::drag,
    &cfd::MomentumBudget::body,
    &cfd::MomentumBudget::side_pressure,
    &cfd::MomentumBudget::body_pressure,
    &cfd::MomentumBudget::body_stress};

// Adds all rows.
void add(cfd::MomentumBudget& sum, const cfd::MomentumBudget& budget);

// What one exchange did; all values are summed, or taken to their extremes, over all ranks.
struct ExchangeReport {
  long grains_inside = 0;   // centre in a cell of the grid, deposited
  long grains_outside = 0;  // centre outside the grid or among closed cells: no gas force
  long grains_alone = 0;    // of those inside: void fraction around them above 0.99
  long limited = 0;         // grains whose closure saw a limited void fraction
  double smallest_void_fraction = 1.0;  // in the cells
  double solid_volume = 0.0;            // of the grains inside, m^3
  double solid_mass = 0.0;              // kg
  double solid_volume_residual = 0.0;   // deposited over given - 1
  int gas_steps = 0;                    // the interval was divided into
  int pressure_iterations = 0;          // sum over the gas steps
  int pressure_fallbacks = 0;           // gas steps whose pressure the fallback had to solve
  double divergence = 0.0;              // largest of the gas steps, see cfd::StepReport
  double removed_mean = 0.0;            // likewise
  double swept_imbalance = 0.0;         // likewise
  double interval = 0.0;                // s
  cfd::MomentumBudget gas_momentum;     // N s, over the interval
  Vec3 force_on_grains = Vec3::Zero();  // N, sum of the new forces
  Vec3 carried = Vec3::Zero();          // N s: sum of GrainRecord::carried, given back to the gas
  Vec3 drag_on_walls = Vec3::Zero();    // N s: drag in directions in which a cell has no free face
  Vec3 unbalanced = Vec3::Zero();   // N s: impulse of drag on grains + carried + on gas + on walls
  double drag_impulse = 0.0;        // N s: sum of magnitudes of the grains' impulses
  double third_law_residual = 0.0;  // |unbalanced| over drag_impulse
  double pressure_residual = 0.0;   // the same for -V grad p
  IntervalLimits limits{};
  double gas_seconds = 0.0;  // wall time in the gas solver on this rank
};

}  // namespace gasgrain::coupling
