// Numbers about the bed that a case file asks for beside height and pressure drop.
#pragma once

#include <string>
#include <vector>

#include "cfd/state_archive.hpp"
#include "coupling/bed_monitor.hpp"
#include "coupling/gas_coupling.hpp"
#include "coupling/monitor_options.hpp"

namespace gasgrain::coupling {

class Monitors {
 public:
  explicit Monitors(const MonitorOptions& options)
      : options_(options), fluxes_(options.planes.size()) {}

  // Names of the values, as columns of timeseries.csv; units in docs/coupling.md.
  std::vector<std::string> names() const;
  bool wants_labels() const { return options_.mixing_direction >= 0; }
  int mixing_direction() const { return options_.mixing_direction; }

  // After every exchange over `interval` [s].
  void note_exchange(const GasCoupling& coupling, double interval);

  // One value per name; fluxes are means since the last call. `labels` of this rank's grains, in
  // the order in which they were given to the last exchange: 1 in the lower layer at the start, 0
  // in the upper one. Collective.
  std::vector<double> take(GasCoupling& coupling, const BedMonitor& bed,
                           std::span<const double> labels);

  // The fluxes under way.
  void visit_state(cfd::StateArchive& archive);

 private:
  struct Flux {
    double up = 0.0, down = 0.0;  // kg, this rank's part
  };

  MonitorOptions options_;
  std::vector<Flux> fluxes_;
  double duration_ = 0.0;  // s
};

// Mass of a grain that passed through the plane on the path v dt that ended at its place, smeared
// over one grain diameter to either side so that the sum over grains is smooth; kg, signed.
double mass_through(const FluxPlane& plane, const GrainRecord& grain, double interval);

// 1 - s^2 / (c (1 - c)): c is the labelled share of the solid volume, s^2 its variance over the gas
// cells weighted by their solid volume (Danckwerts's intensity of segregation). 0: apart, near 1:
// mixed down to the kernel's width; NaN without both kinds. `labels` as GrainTransfer::received().
// Collective.
double mixing_index(GasCoupling& coupling, std::span<const double> labels);

}  // namespace gasgrain::coupling
