// Section [coupling] of a case file: docs/coupling.md.
#pragma once

#include <string>

#include "cfd/gas_case.hpp"
#include "coupling/audit_bounds.hpp"
#include "coupling/mapping.hpp"
#include "coupling/momentum_exchange.hpp"
#include "coupling/monitor_options.hpp"
#include "coupling/shared/config_table.hpp"

namespace gasgrain::coupling {

enum class Feedback {
  two_way,  // grains displace and drag the gas
  one_way,  // the gas does not notice the grains: void fraction 1, no drag on the gas
};

enum class DragUpdate {
  held,      // the drag on a grain is constant between exchanges
  dem_step,  // it follows the grain's velocity in every DEM step
};

struct CouplingOptions {
  std::string drag_name = "gidaspow";
  DragOptions drag;
  Feedback feedback = Feedback::two_way;
  DragUpdate drag_update = DragUpdate::held;
  bool viscous_stress = false;  // grains feel V div(eps tau), the gas the opposite
  Mapping mapping = Mapping::spline;
  double exchange_interval = 0.0;  // s, requested interval between exchanges; 0 = from the limits
  // m, standard deviation of the deposition kernel; 0: from dx and d, other mappings than the
  // spline are not smoothed
  double kernel_width = 0.0;
  double average_from = 0.0;       // s of gas time: start of the time means
  double series_interval = 0.0;    // s of gas time between rows; 0 = a tenth of the frames'
  double progress_interval = 0.0;  // s of gas time between progress lines; 0 = as the frames
  std::string case_name;           // in summary.json
  MonitorOptions monitor;
  AuditBounds audit;
};

// Throws UserError: unknown keys or closures, values out of range.
CouplingOptions read_coupling_options(const ConfigTable& coupling_table,
                                      const cfd::GasCase& gas_case);

}  // namespace gasgrain::coupling
