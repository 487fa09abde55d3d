// A group of LIGGGHTS's grains and what surrounds them, as a coupled run sees them.
#pragma once

#include <mpi.h>
#include <pointers.h>

#include "coupling/dem_host.hpp"
#include "coupling/grain_traffic.hpp"
#include "coupling/grain_values.hpp"

namespace gasgrain::coupling {

class LiggghtsHost : public DemHost, private LAMMPS_NS::Pointers {
 public:
  // `group_bit`: mask of the coupled group. Duplicates the communicator of `liggghts`.
  LiggghtsHost(LAMMPS_NS::LAMMPS* liggghts, int group_bit);
  ~LiggghtsHost() override;
  LiggghtsHost(const LiggghtsHost&) = delete;
  LiggghtsHost& operator=(const LiggghtsHost&) = delete;

  MPI_Comm communicator() const { return communicator_; }

  // visit(i) for every coupled grain of this rank.
  template <class Visit>
  void for_each_grain(Visit&& visit) const {
    for (int i = 0; i < count_of_atoms(); ++i) {
      if (coupled(i)) visit(i);
    }
  }
  bool coupled(int i) const;
  GrainPassage passage(int i) const;  // time 0
  GrainValues& values() { return values_; }
  const GrainValues& values() const { return values_; }
  // `coefficients` as CoupledRun::exchange() leaves them; `interval` [s]: over this the gas gives.
  void hold(const std::vector<Vec3>& forces, const std::vector<double>& coefficients,
            double interval);

  double time() const override;
  double step() const override;
  Vec3 gravity() const override;
  RunProgress progress() const override;
  std::vector<std::string> unmeasured_walls() const override;
  bool walls_move() const override;
  std::vector<GrainRecord> records() const override;
  void add_carried(std::vector<GrainRecord>& grains, double elapsed, double given) const override;
  GrainState grain_state() const override;
  void set_labels(const std::vector<double>& labels) override;
  std::vector<double> labels() const override;
  double gas_power() const override;
  GrainTotals totals() const override;
  GrainSizes sizes() const override;
  Vec3 take_wall_impulse() override;
  plugins::LargestOverlap take_largest_overlap() override;
  void print(const std::string& text) override;

 private:
  int count_of_atoms() const;

  MPI_Comm communicator_ = MPI_COMM_NULL;
  int group_bit_;
  GrainValues values_;
};

}  // namespace gasgrain::coupling
