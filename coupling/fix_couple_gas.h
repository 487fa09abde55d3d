// fix ID group couple/gas case CASE.toml [out DIR]
//
// Couples the grains of the group with the gas of the case file: docs/coupling.md. A thin adapter
// of coupling/coupled_run.hpp to LIGGGHTS. The gas force on each grain is held between exchanges
// and moves with the atom from rank to rank.
//
// Vector output f_ID[1..10]: time of the gas (s), pressure drop (Pa), bed height (m), weight over
// area (Pa), interval between exchanges (s), vertical momentum residual over the weight, residual
// of the drag exchange, of the solid volume, of continuity, grains outside the gas grid; from 11 on
// the monitors of the case file in the order of the columns of timeseries.csv.
#ifdef FIX_CLASS
// clang-format off
FixStyle(couple/gas,gasgrain::coupling::FixCoupleGas)
// clang-format on
#else
// no #pragma once: the same file is read again under *_CLASS
#ifndef GASGRAIN_FIX_COUPLE_GAS_H
#define GASGRAIN_FIX_COUPLE_GAS_H

#include <fix.h>

#include <memory>
#include <string>

#include "coupling/coupled_run.hpp"
#include "coupling/liggghts_host.hpp"

namespace gasgrain::coupling {

class FixCoupleGas : public LAMMPS_NS::Fix, public plugins::HeldForceFix {
 public:
  FixCoupleGas(LAMMPS_NS::LAMMPS* liggghts, int argument_count, char** arguments);
  ~FixCoupleGas() override;

  int setmask() override;
  void setup_pre_exchange() override;
  void pre_exchange() override;
  void setup(int vflag) override;
  void post_force(int vflag) override;
  void end_of_step() override;
  void post_run() override;
  double compute_vector(int index) override;

  Vec3 cell_size() const { return run_->coupling().gas().decomposition().grid().spacing(); }  // m

  // The held force moves, is sorted and exchanged with the atom.
  void grow_arrays(int count) override;
  void copy_arrays(int from, int to, int) override;
  void set_arrays(int i) override;
  int pack_exchange(int i, double* buffer) override;
  int unpack_exchange(int i, double* buffer) override;
  double memory_usage() override;

  // Restart files: the held forces go with the grains, the rest into an HDF5 file whose name the
  // restart file holds.
  void write_restart(FILE* file) override;
  void restart(char* buffer) override;
  int pack_restart(int i, double* buffer) override;
  void unpack_restart(int i, int nth) override;
  int size_restart(int i) override;
  int maxsize_restart() override;

  plugins::HeldForces held_forces() const override;
  void held_forces_applied(const Vec3& sum) override;
  bool end_of_step_uses_atoms() const override { return run_->exchange_due(); }

 private:
  void tell_who_leaves(GrainTraffic::Moment moment);
  void check_host(const std::string& where) const;
  Vec3 add_held_forces();

  std::unique_ptr<LiggghtsHost> host_;
  std::unique_ptr<CoupledRun> run_;
  std::string state_directory_;  // for states when no checkpoint is under way
};

}  // namespace gasgrain::coupling
#endif
#endif
