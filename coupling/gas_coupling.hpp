// Gas and grains exchange volume and momentum: one coupling step.
//
// Protocol: construct; begin() once; then exchange() after every interval of DEM steps. All calls
// are collective and throw UserError on every rank. The forces are held until the next exchange.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "cfd/gas_solver.hpp"
#include "cfd/state_archive.hpp"
#include "coupling/coupling_options.hpp"
#include "coupling/exchange_report.hpp"
#include "coupling/grain_transfer.hpp"
#include "coupling/owed_impulse.hpp"
#include "coupling/void_fraction.hpp"

namespace gasgrain::coupling {

class GasCoupling {
 public:
  GasCoupling(const cfd::GasCase& gas_case, const CouplingOptions& options, MPI_Comm communicator);

  // First exchange: the grains appear in a gas in its initial state. `forces` [N] gets one entry
  // per local grain, zero for grains outside the grid. `clock` [s] is what moving bodies go by.
  ExchangeReport begin(std::span<Vec3> forces, std::span<const GrainRecord> grains,
                       double clock = 0.0);
  // The grains moved for `interval` [s]: advances the gas over it and returns the new forces.
  ExchangeReport exchange(std::span<Vec3> forces, std::span<const GrainRecord> grains,
                          double interval);

  // B of this rank's grains at the last exchange, kg/s; entries of grains without a gas force stay
  // as they are. Collective.
  void coefficients_of(std::span<double> grains) const;

  // Saves or restores all that enters later exchanges, without the forces that grains hold.
  // Collective.
  void visit_state(cfd::StateArchive& archive);

  const cfd::GasSolver& gas() const { return gas_; }
  const CouplingOptions& options() const { return options_; }
  const Deposition& deposition() const { return deposition_; }
  Deposition& deposition() { return deposition_; }
  const GrainTransfer& transfer() const { return transfer_; }         // grains of the last exchange
  const cfd::Field& void_fraction() const { return void_fraction_; }  // at the last exchange
  double kernel_width() const { return kernel_width_; }               // m

 private:
  void move_bodies(double interval);
  void find_closed_cells();
  void adapt_kernel();
  void survey_grains();
  void send_grains_to_gas_ranks(std::span<const GrainRecord> grains);
  void deposit_void_fraction();
  void gather_sauter_diameters();
  void evaluate_drag();
  void evaluate_viscous_force();
  void deposit_drag(double interval);
  void give_back_owed_impulse(double interval);
  int steps_for(double time) const;
  void advance_gas(double interval);
  void add_drag_on_walls(double interval);
  double wall_motion_limit() const;
  void gather_forces();
  void add_owed_force();
  // Completes the report by what the ranks add up to; coupling/exchange_report.cpp.
  void measure(double interval);

  CouplingOptions options_;
  cfd::GasSolver gas_;
  Deposition deposition_;
  GrainTransfer transfer_;
  double kernel_width_ = 0.0;       // m
  double kernel_diameter_ = 0.0;    // m, largest grain so far
  bool kernel_is_adapted_ = false;  // to that largest grain

  // Per received grain.
  std::vector<double> coefficients_;      // B, kg/s
  std::vector<double> void_fractions_;    // eps around it
  std::vector<double> sauter_diameters_;  // of the originals around it, m; mixtures only
  std::vector<Vec3> viscous_;             // V div(eps tau), N; empty without it
  std::vector<Vec3> drag_, pressure_,
      forces_;  // N; drag_ with viscous_; forces_ = drag_ + pressure_

  // Cells.
  cfd::Field void_fraction_;                       // at the end of the interval
  std::array<bool, 3> has_closed_cells_{};         // open cells of this rank without a free face
  cfd::VectorField velocity_, pressure_gradient_;  // as the grains see them: means over gas steps
  cfd::VectorField viscous_force_;  // div(eps tau) after the last gas step, N/m^3; empty without it
  OwedImpulse owed_;                // because of intervals that changed their length, drag held
  bool is_owed_ = false;            // grains carry an impulse into this exchange
  ExchangeReport report_;           // of the exchange under way, this rank's part
};

}  // namespace gasgrain::coupling
