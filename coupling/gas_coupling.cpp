// The coupling step (design: coupling numerics). At time t, after the grains moved over the
// interval:
//
//   1  the grains' data go to the ranks that own their cells
//   2  eps = 1 - D V at the grains' new places
//   3  B = beta V / (1 - eps) per grain with eps and u gathered by D^T; u as the grains felt it
//      last; with viscous_stress also W = V div(eps tau), of the gas as the last exchange left it
//   4  D B and D (B v - W) go to the gas
//   5  the gas advances over the interval, with B (u - v) implicit
//   6  F = B (u - v) + W - V grad p with u and grad p gathered by D^T
//   7  the forces go back and are held over the next interval
//
// What the grains received since the last exchange differs from what the gas gave when the interval
// changed its length, or when their drag followed their velocities: the difference is carried per
// grain (GrainRecord::carried) and given back in 4, that of intervals by gas and grains together
// (owed_impulse.cpp).
//
// D spreads and D^T gathers with one set of weights, and the solver spreads cell values to faces
// with the shares by which it samples faces at cells. So sum F_drag dt is the momentum that the gas
// lost, to round-off, whatever the state. Directions in which a cell has no free face (a grid one
// cell deep) hold the gas at the wall's velocity: there the drag goes to the wall. When the
// interval exceeds the gas solver's largest step, it is divided: eps changes linearly, and the
// grains see the means of u and of their share of grad p (cfd/felt_gradient.cpp).
//
// 3, 4 and 6, what grains and gas give each other, are in drag_exchange.cpp.
#include "coupling/gas_coupling.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "cfd/halo_exchange.hpp"
#include "cfd/loops.hpp"
#include "coupling/shared/error.hpp"

namespace gasgrain::coupling {

namespace {

constexpr double width_over_spacing = 0.8;  // kernel: at least this standard deviation
constexpr double width_over_diameter = 1.2;

double largest_spacing(const cfd::Grid& grid) {
  double largest = 0;
  for (int d = 0; d < 3; ++d) {
    if (grid.cells[d] > 1) largest = std::max(largest, grid.spacing()[d]);
  }
  return largest > 0 ? largest : grid.spacing().minCoeff();
}

void allreduce(std::span<double> values, MPI_Op operation, MPI_Comm communicator) {
  MPI_Allreduce(MPI_IN_PLACE, values.data(), static_cast<int>(values.size()), MPI_DOUBLE, operation,
                communicator);
}

}  // namespace

GasCoupling::GasCoupling(const cfd::GasCase& gas_case, const CouplingOptions& options,
                         MPI_Comm communicator)
    : options_(options),
      gas_(gas_case, communicator),
      deposition_(gas_.decomposition(), gas_.walls(), options.mapping),
      transfer_(gas_.decomposition()),
      void_fraction_(gas_.decomposition().block().size, 1.0) {
  if (gas_.walls().spans_bodies) {
    throw UserError(
        "numerics.immersed_boundary = \"volume-forcing\" is for gasgrain-gas alone: inside its "
        "bodies gas moves where grains cannot be; use \"interpolation\"");
  }
  for (int d = 0; d < 3; ++d) {
    velocity_[d] = cfd::Field(gas_.decomposition().block().size);
    pressure_gradient_[d] = cfd::Field(gas_.decomposition().block().size);
    if (options_.viscous_stress) viscous_force_[d] = cfd::Field(gas_.decomposition().block().size);
  }
  find_closed_cells();
  kernel_width_ = options_.kernel_width;
  if (kernel_width_ > 0) deposition_.set_width(kernel_width_);
}

void GasCoupling::find_closed_cells() {
  const cfd::WallGeometry& walls = gas_.walls();
  for (int d = 0; d < 3; ++d) {
    has_closed_cells_[d] = false;
    cfd::for_each_cell(void_fraction_.size(), [&](int i, int j, int k) {
      const double free =
          walls.lower_share[d](i, j, k) + walls.upper_share[d](i, j, k) + walls.host[d](i, j, k);
      if (free == 0 && deposition_.open_fraction()(i, j, k) > 0) has_closed_cells_[d] = true;
    });
  }
}

ExchangeReport GasCoupling::begin(std::span<Vec3> forces, std::span<const GrainRecord> grains,
                                  double clock) {
  report_ = {};
  gas_.set_body_clock(clock);
  deposition_.set_walls(gas_.walls());
  find_closed_cells();
  send_grains_to_gas_ranks(grains);
  deposit_void_fraction();
  gas_.grains().void_fraction = void_fraction_;
  gas_.accept_void_fraction_as_old();
  gas_.sample_at_cells(velocity_, pressure_gradient_);
  evaluate_drag();
  evaluate_viscous_force();
  deposit_drag(0.0);
  gather_forces();
  transfer_.return_to_senders(forces, forces_);
  measure(0.0);
  return report_;
}

ExchangeReport GasCoupling::exchange(std::span<Vec3> forces, std::span<const GrainRecord> grains,
                                     double interval) {
  report_ = {};
  move_bodies(interval);
  send_grains_to_gas_ranks(grains);
  deposit_void_fraction();
  evaluate_drag();
  evaluate_viscous_force();
  deposit_drag(interval);
  advance_gas(interval);
  gather_forces();
  transfer_.return_to_senders(forces, forces_);
  measure(interval);
  return report_;
}

// To where they are at the end of the interval, as the grains are. The gas's steps within it keep
// them there, so that the void fractions at both ends are per the same open volume.
void GasCoupling::move_bodies(double interval) {
  if (!gas_.move_bodies(gas_.time() + interval)) return;
  deposition_.set_walls(gas_.walls());
  find_closed_cells();
}

void GasCoupling::coefficients_of(std::span<double> grains) const {
  transfer_.return_to_senders(grains, coefficients_);
}

void GasCoupling::visit_state(cfd::StateArchive& archive) {
  gas_.visit_state(archive);
  archive.number("kernel_width", kernel_width_);
  archive.number("kernel_diameter", kernel_diameter_);
  archive.cells("deposited_void_fraction", void_fraction_);
  for (int d = 0; d < 3; ++d) {
    const std::string axis(1, "xyz"[d]);
    archive.cells("felt_velocity_" + axis, velocity_[d]);
    archive.cells("felt_pressure_gradient_" + axis, pressure_gradient_[d]);
    if (options_.viscous_stress) archive.cells("viscous_force_" + axis, viscous_force_[d]);
  }
  owed_.visit_state(archive, void_fraction_.size());
  if (!archive.restores()) return;
  deposition_.set_walls(gas_.walls());
  find_closed_cells();
  const cfd::Decomposition& decomposition = gas_.decomposition();
  cfd::fill_ghosts(decomposition, velocity_);
  cfd::fill_ghosts(decomposition, pressure_gradient_);
  if (options_.viscous_stress) cfd::fill_ghosts(decomposition, viscous_force_);
  kernel_is_adapted_ = true;
  deposition_.set_width(kernel_width_, kernel_diameter_);
}

// The kernel follows the largest grain so far: its width, and how many cells a grain reaches over.
void GasCoupling::adapt_kernel() {
  const bool is_spline = options_.mapping == Mapping::spline;
  const bool chooses_width = is_spline && options_.kernel_width <= 0;
  if (is_spline && !chooses_width) return;
  double largest = kernel_diameter_;
  for (const GrainRecord& grain : transfer_.received())
    largest = std::max(largest, grain_diameter(grain));
  allreduce({&largest, 1}, MPI_MAX, gas_.decomposition().communicator());
  if (largest <= kernel_diameter_ && kernel_is_adapted_) return;
  kernel_is_adapted_ = true;
  kernel_diameter_ = largest;
  if (chooses_width) {
    kernel_width_ = std::max(width_over_spacing * largest_spacing(gas_.decomposition().grid()),
                             width_over_diameter * largest);
  }
  deposition_.set_width(kernel_width_, kernel_diameter_);
}

// The lightest grains, and whether any received more or less than the gas gave.
void GasCoupling::survey_grains() {
  if (options_.feedback == Feedback::one_way) return;
  std::array<double, 2> largest{};
  for (const GrainRecord& grain : transfer_.received()) {
    largest[0] = std::max(largest[0], options_.drag.density * grain.volume / grain.mass);
    if (!grain.carried.isZero(0.0)) largest[1] = 1.0;
  }
  allreduce(largest, MPI_MAX, gas_.decomposition().communicator());
  gas_.grains().density_ratio = largest[0];
  is_owed_ = largest[1] > 0;
}

void GasCoupling::send_grains_to_gas_ranks(std::span<const GrainRecord> grains) {
  transfer_.send(grains);
  adapt_kernel();
  survey_grains();
  const std::vector<GrainRecord>& received = transfer_.received();
  std::vector<Vec3> positions(received.size());
  for (std::size_t n = 0; n < received.size(); ++n) positions[n] = received[n].position;
  std::vector<double> diameters;
  if (options_.mapping != Mapping::spline) {
    diameters.resize(received.size());
    for (std::size_t n = 0; n < received.size(); ++n) diameters[n] = grain_diameter(received[n]);
  }
  deposition_.locate(positions, diameters);
}

void GasCoupling::deposit_void_fraction() {
  if (options_.feedback == Feedback::one_way) return;
  const std::vector<GrainRecord>& grains = transfer_.received();
  std::vector<std::array<double, 1>> volumes(grains.size());
  for (std::size_t n = 0; n < grains.size(); ++n) volumes[n] = {grains[n].volume};
  cfd::Field solid(void_fraction_.size());
  deposition_.deposit<1>({&solid}, volumes);
  double smallest = 1.0;
  cfd::for_each_cell(solid.size(), [&](int i, int j, int k) {
    const double eps = 1.0 - solid(i, j, k);
    void_fraction_(i, j, k) = eps;
    smallest = std::min(smallest, eps);
  });
  allreduce({&smallest, 1}, MPI_MIN, gas_.decomposition().communicator());
  report_.smallest_void_fraction = smallest;
  if (smallest > 0) return;
  std::ostringstream message;
  message
      << "the void fraction of a gas cell is " << smallest
      << ", but must be positive; grains overlap strongly or the deposition kernel is too narrow "
         "for them (coupling.mapping is "
      << mapping_name(options_.mapping) << ", coupling.kernel_width " << kernel_width_
      << " m here): check the packing or widen the kernel";
  throw UserError(message.str());
}

// Equal steps that the gas would need for that time now.
int GasCoupling::steps_for(double time) const {
  return std::max(1, static_cast<int>(std::ceil(time / gas_.largest_stable_step() * (1 - 1e-9))));
}

void GasCoupling::advance_gas(double interval) {
  const double start = MPI_Wtime();
  const cfd::Field old_void_fraction = gas_.grains().void_fraction;
  double left = interval;
  int steps = steps_for(left);
  const bool divided = steps > 1;
  if (divided) gas_.start_means(void_fraction_);
  while (steps > 0) {
    const double dt = left / steps;
    left = steps > 1 ? left - dt : 0.0;
    const double share = 1.0 - left / interval;
    cfd::Field& eps = gas_.grains().void_fraction;
    for (std::size_t n = 0; n < eps.count(); ++n) {
      eps[n] = steps == 1 ? void_fraction_[n]
                          : (1 - share) * old_void_fraction[n] + share * void_fraction_[n];
    }
    ++report_.gas_steps;
    const cfd::StepReport step = gas_.advance(dt);
    report_.pressure_iterations += step.pressure.iterations;
    report_.pressure_fallbacks += step.pressure.fallbacks;
    report_.divergence = std::max(report_.divergence, step.divergence);
    report_.removed_mean = std::max(report_.removed_mean, step.removed_mean);
    report_.swept_imbalance = std::max(report_.swept_imbalance, step.swept_imbalance);
    add(report_.gas_momentum, step.momentum);
    steps = left > 0 ? steps_for(left) : 0;  // the flow changes its largest step on the way
  }
  if (divided)
    gas_.sample_means_at_cells(velocity_, pressure_gradient_);
  else
    gas_.sample_at_cells(velocity_, pressure_gradient_);
  if (options_.viscous_stress) gas_.sample_viscous_force_at_cells(viscous_force_);
  report_.interval = interval;
  report_.gas_seconds = MPI_Wtime() - start;
  add_drag_on_walls(interval);
}

}  // namespace gasgrain::coupling
