// What a coupled run accounts for from row to row: momentum, energy, coming and going grains,
// overlaps.
//
// Calls in the order of CoupledRun's protocol: begin(); per DEM step force_applied(); at an
// exchange note_gas_work() before and exchanged() after it; close() at every row.
#pragma once

#include <mpi.h>

#include <span>
#include <vector>

#include "coupling/audit_bounds.hpp"
#include "coupling/dem_host.hpp"
#include "coupling/energy_audit.hpp"
#include "coupling/grain_traffic.hpp"
#include "coupling/momentum_audit.hpp"
#include "liggghts_plugins/contact_statistics.hpp"

namespace gasgrain::coupling {

// The interval between two rows.
struct AuditRow {
  MomentumBalance balance;
  EnergyBalance energy;
  TrafficSums traffic;
  GrainTotals grains;              // at its end
  double momentum_residual = 0.0;  // vertical, over the grains' weight
  double heating = 0.0;  // energy from nowhere over that of motion, springs and a lift by d
  plugins::LargestOverlap overlap;
};

class RunAudit {
 public:
  // `drag_follows`: the gas forces follow the grains' velocities, so that their sum changes from
  // step to step.
  RunAudit(const AuditBounds& bounds, Feedback feedback, bool drag_follows, DemHost& host,
           MPI_Comm communicator);

  // Starts the first interval after the first exchange. Returns the grains' sums. Collective.
  GrainTotals begin(const ExchangeReport& first);
  // The set-up of a run computes all forces anew; `force_sum` as in force_applied().
  void set_up(const Vec3& force_sum);
  // After a DEM step [s]; `force_sum` of the gas on this rank's grains [N] is read only when the
  // drag follows.
  void force_applied(double dem_step, const Vec3& force_sum);
  // Of the forces that the grains hold since `elapsed` [s].
  void note_gas_work(double elapsed);
  void exchanged(const ExchangeReport& report);
  // Of new `forces` on this rank's `grains`, N.
  void note_gas_power(std::span<const Vec3> forces, const std::vector<GrainRecord>& grains);
  // `elapsed` since the last exchange, s; `held` is the gas force on the grain, N.
  void grain_appeared(GrainPassage passage, double elapsed, GrainTraffic::Moment moment,
                      double dem_step);
  void grain_left(GrainPassage passage, const Vec3& held, double elapsed,
                  GrainTraffic::Moment moment, double dem_step);

  // What the host has counted since the last call; before a checkpoint. Collective.
  void collect_from_host();
  // Balances along `axis`; starts the next interval. Collective.
  AuditRow close(int axis);
  std::vector<AuditViolation> violations(const AuditRow& row, const ExchangeReport& exchange,
                                         int axis) const;

  void visit_state(cfd::StateArchive& archive);

 private:
  double time_of_passage(double elapsed, GrainTraffic::Moment moment, double dem_step) const;

  AuditBounds bounds_;
  Feedback feedback_;
  bool drag_follows_;
  DemHost& host_;
  MPI_Comm communicator_;
  MomentumAudit momentum_;
  EnergyAudit energy_;
  GrainTraffic traffic_;
  Vec3 held_force_ = Vec3::Zero();     // N, sum over the grains
  Vec3 applied_force_ = Vec3::Zero();  // the one in the integrator's present force
  // The same on this rank when the drag follows the grains, and its impulse since the last row.
  Vec3 applied_sum_ = Vec3::Zero(), received_sum_ = Vec3::Zero();
  double gas_power_ = 0.0;            // W, at the last exchange on this rank's grains then
  Vec3 wall_impulse_ = Vec3::Zero();  // N s, of walls on grains, collected since the last row
  plugins::LargestOverlap overlap_;   // likewise
};

}  // namespace gasgrain::coupling
