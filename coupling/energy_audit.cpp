// Everything but the dissipation is measured; the dissipation is what is missing. So this balance
// always closes, and what it can show is a dissipation of the wrong sign: energy from nowhere.
#include "coupling/energy_audit.hpp"

namespace gasgrain::coupling {

EnergyBalance EnergyAudit::close(const GrainTotals& now, const TrafficSums& traffic,
                                 const Vec3& gravity, MPI_Comm communicator) {
  EnergyBalance balance;
  balance.kinetic = now.kinetic_energy;
  balance.rotation = now.rotation_energy;
  balance.potential = -gravity.dot(now.mass_moment);
  balance.elastic = now.elastic_energy;
  balance.gas_work = gas_work_;
  MPI_Allreduce(MPI_IN_PLACE, &balance.gas_work, 1, MPI_DOUBLE, MPI_SUM, communicator);
  balance.passage = traffic.energy - gravity.dot(traffic.mass_moment);
  const double before = last_.kinetic_energy + last_.rotation_energy -
                        gravity.dot(last_.mass_moment) + last_.elastic_energy;
  const double after = balance.kinetic + balance.rotation + balance.potential + balance.elastic;
  balance.dissipated = balance.gas_work + balance.passage - (after - before);
  begin(now);
  return balance;
}

void EnergyAudit::visit_state(cfd::StateArchive& archive) {
  archive.partial_sums("gas_work", {&gas_work_, 1});
  coupling::visit_state(archive, "energy_", last_);
}

}  // namespace gasgrain::coupling
