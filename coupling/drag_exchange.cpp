// What grains and gas give each other: 3, 4 and 6 of the coupling step (gas_coupling.cpp).
#include <array>
#include <vector>

#include "cfd/felt_gradient.hpp"
#include "cfd/loops.hpp"
#include "coupling/gas_coupling.hpp"

namespace gasgrain::coupling {

// V and V/d0 spread alike; their ratio around a grain is the Sauter mean diameter of the originals.
void GasCoupling::gather_sauter_diameters() {
  const std::vector<GrainRecord>& grains = transfer_.received();
  std::vector<std::array<double, 2>> amounts(grains.size());
  for (std::size_t n = 0; n < grains.size(); ++n)
    amounts[n] = {grains[n].volume, grains[n].volume / grains[n].original_diameter};
  cfd::Field volume(void_fraction_.size()), surface(void_fraction_.size());
  deposition_.deposit<2>({&volume, &surface}, amounts);
  deposition_.gather<2>(amounts, {&volume, &surface});
  sauter_diameters_.resize(grains.size());
  for (std::size_t n = 0; n < grains.size(); ++n) {
    const auto& [v, s] = amounts[n];
    sauter_diameters_[n] = s > 0 ? v / s : grains[n].original_diameter;
  }
}

void GasCoupling::evaluate_drag() {
  if (options_.drag.mixture) gather_sauter_diameters();
  const std::vector<GrainRecord>& grains = transfer_.received();
  std::vector<std::array<double, 4>> gathered(grains.size());
  deposition_.gather<4>(gathered, {&void_fraction_, &velocity_[0], &velocity_[1], &velocity_[2]});
  coefficients_.assign(grains.size(), 0.0);
  void_fractions_.resize(grains.size());
  for (std::size_t n = 0; n < grains.size(); ++n) {
    const auto& [around, u, v, w] = gathered[n];
    void_fractions_[n] = around;
    if (!deposition_.takes_part(n)) continue;
    SurroundingGas gas{around, {u, v, w}};
    if (options_.drag.mixture) gas.sauter_diameter = sauter_diameters_[n];
    coefficients_[n] = exchange_coefficient(grains[n], gas, options_.drag);
    if (void_fraction_is_limited(gas, options_.drag)) ++report_.limited;
  }
}

// Of the mixture's viscous force each phase has its share of the volume: grains (1 - eps), which is
// V per grain, the gas eps. The gas solver computes all of it; deposit_drag() takes W from the gas.
void GasCoupling::evaluate_viscous_force() {
  if (!options_.viscous_stress) return;
  const std::vector<GrainRecord>& grains = transfer_.received();
  std::vector<std::array<double, 3>> gathered(grains.size());
  deposition_.gather<3>(gathered, {&viscous_force_[0], &viscous_force_[1], &viscous_force_[2]});
  viscous_.resize(grains.size());
  for (std::size_t n = 0; n < grains.size(); ++n) {
    const auto& [x, y, z] = gathered[n];
    viscous_[n] = grains[n].volume * Vec3(x, y, z);
  }
}

// In units of B v: what grains carry whose drag followed them is given back over the interval.
void GasCoupling::deposit_drag(double interval) {
  if (options_.feedback == Feedback::one_way) return;
  const bool follows = options_.drag_update == DragUpdate::dem_step;
  const std::vector<GrainRecord>& grains = transfer_.received();
  std::vector<std::array<double, 4>> amounts(grains.size());
  for (std::size_t n = 0; n < grains.size(); ++n) {
    Vec3 momentum = coefficients_[n] * grains[n].velocity;
    if (interval > 0 && follows) momentum -= grains[n].carried / interval;
    if (options_.viscous_stress) momentum -= viscous_[n];
    amounts[n] = {coefficients_[n], momentum[0], momentum[1], momentum[2]};
  }
  cfd::GrainPhase& phase = gas_.grains();
  deposition_.deposit<4>({&phase.momentum_exchange, &phase.exchange_momentum[0],
                          &phase.exchange_momentum[1], &phase.exchange_momentum[2]},
                         amounts);
  if (interval > 0 && !follows) give_back_owed_impulse(interval);
}

// Of intervals that changed their length: owed_impulse.cpp.
void GasCoupling::give_back_owed_impulse(double interval) {
  const double lag = cfd::lag_of(gas_.grains().density_ratio);
  const bool remembers = lag > 0.0 && !owed_.is_empty();
  if (!is_owed_ && !remembers) return owed_.forget();
  const std::vector<GrainRecord>& grains = transfer_.received();
  std::vector<std::array<double, 3>> amounts(grains.size());
  for (std::size_t n = 0; n < grains.size(); ++n)
    for (int d = 0; d < 3; ++d) amounts[n][d] = grains[n].carried[d] / interval;
  cfd::VectorField force;
  force.fill(cfd::Field(void_fraction_.size()));
  deposition_.deposit<3>({&force[0], &force[1], &force[2]}, amounts);
  owed_.split(force, void_fraction_, gas_.walls(), lag);
  for (int d = 0; d < 3; ++d) {
    cfd::Field& momentum = gas_.grains().exchange_momentum[d];
    for (std::size_t n = 0; n < momentum.count(); ++n) momentum[n] -= force[d][n];
  }
}

void GasCoupling::gather_forces() {
  const std::vector<GrainRecord>& grains = transfer_.received();
  std::vector<std::array<double, 6>> gathered(grains.size());
  const cfd::VectorField &u = velocity_, &p = pressure_gradient_;
  deposition_.gather<6>(gathered, {&u[0], &u[1], &u[2], &p[0], &p[1], &p[2]});
  drag_.resize(grains.size());
  pressure_.resize(grains.size());
  forces_.resize(grains.size());
  for (std::size_t n = 0; n < grains.size(); ++n) {
    const auto& g = gathered[n];
    drag_[n] = coefficients_[n] * (Vec3(g[0], g[1], g[2]) - grains[n].velocity);
    if (options_.viscous_stress) drag_[n] += viscous_[n];
    pressure_[n] = -grains[n].volume * Vec3(g[3], g[4], g[5]);
  }
  if (!owed_.is_empty()) add_owed_force();
  for (std::size_t n = 0; n < grains.size(); ++n) forces_[n] = drag_[n] + pressure_[n];
}

// The grains' part of what they received beyond what the gas gave.
void GasCoupling::add_owed_force() {
  const std::vector<GrainRecord>& grains = transfer_.received();
  std::vector<std::array<double, 3>> gathered(grains.size());
  const cfd::VectorField& h = owed_.felt();
  deposition_.gather<3>(gathered, {&h[0], &h[1], &h[2]});
  for (std::size_t n = 0; n < grains.size(); ++n) {
    const auto& [x, y, z] = gathered[n];
    drag_[n] -= grains[n].volume * Vec3(x, y, z);
  }
}

// What the drag gives to walls: the momentum of cells' directions without a free face.
void GasCoupling::add_drag_on_walls(double interval) {
  if (options_.feedback == Feedback::one_way) return;
  const cfd::GrainPhase& phase = gas_.grains();
  const cfd::WallGeometry& walls = gas_.walls();
  const cfd::Index3 size = gas_.decomposition().block().size;
  const double volume = gas_.decomposition().grid().cell_volume();
  for (int d = 0; d < 3; ++d) {
    if (!has_closed_cells_[d]) continue;
    double force = 0;
    cfd::for_each_cell(size, [&](int i, int j, int k) {
      const std::ptrdiff_t n = void_fraction_.index(i, j, k);
      if (walls.lower_share[d][n] + walls.upper_share[d][n] + walls.host[d][n] > 0) return;
      force += deposition_.open_fraction()[n] *
               (phase.exchange_momentum[d][n] - phase.momentum_exchange[n] * velocity_[d][n]);
    });
    report_.drag_on_walls[d] += interval * volume * force;
  }
}

}  // namespace gasgrain::coupling
