// Energy of the grains over an interval: where it came from and what became heat.
#pragma once

#include <mpi.h>

#include "cfd/state_archive.hpp"
#include "coupling/grain_totals.hpp"
#include "coupling/grain_traffic.hpp"

namespace gasgrain::coupling {

// change of (kinetic + rotation + potential + elastic) = gas_work + passage - dissipated
struct EnergyBalance {
  double kinetic = 0.0;    // J, translation, now
  double rotation = 0.0;   // J
  double potential = 0.0;  // J, of weight, zero at the origin
  double elastic = 0.0;    // J, normal springs between grains
  double gas_work = 0.0;   // J in the interval, of the gas force on the grains
  double passage = 0.0;    // J, of grains that appeared less those that left
  // J: contacts and friction take it, and springs at walls and tangential ones store it; work of
  // moving walls counts negative. Negative without moving walls: the DEM makes energy.
  double dissipated = 0.0;
};

class EnergyAudit {
 public:
  void begin(const GrainTotals& grains) {
    last_ = grains;
    gas_work_ = 0.0;
  }
  void add_gas_work(double work) { gas_work_ += work; }  // J, on this rank's grains

  // Balance since begin() or the last close(), and starts the next interval. `gravity` in m/s^2.
  // Collective.
  EnergyBalance close(const GrainTotals& now, const TrafficSums& traffic, const Vec3& gravity,
                      MPI_Comm communicator);

  void visit_state(cfd::StateArchive& archive);

 private:
  GrainTotals last_;
  double gas_work_ = 0.0;
};

}  // namespace gasgrain::coupling
