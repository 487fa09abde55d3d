#include "coupling/coupling_options.hpp"

#include <filesystem>

namespace gasgrain::coupling {

CouplingOptions read_coupling_options(const ConfigTable& table, const cfd::GasCase& gas_case) {
  CouplingOptions options;
  options.drag_name = table.choice_or("drag", options.drag_name, drag_closure_names());
  options.drag.closure = find_drag_closure(options.drag_name);
  options.drag.density = gas_case.gas.density;
  options.drag.viscosity = gas_case.gas.viscosity;
  options.drag.smallest_void_fraction =
      table.number_or("smallest_void_fraction", options.drag.smallest_void_fraction,
                      {.lower = 0, .upper = 1, .lower_open = true});
  options.drag.mixture = table.choice_or("mixture", "off", {"off", "sauter"}) == "sauter";
  options.feedback = table.choice_or("feedback", "two-way", {"two-way", "one-way"}) == "two-way"
                         ? Feedback::two_way
                         : Feedback::one_way;
  options.drag_update = table.choice_or("drag_update", "held", {"held", "dem-step"}) == "held"
                            ? DragUpdate::held
                            : DragUpdate::dem_step;
  options.viscous_stress = table.flag_or("viscous_stress", false);
  options.mapping =
      find_mapping(table.choice_or("mapping", mapping_name(options.mapping), mapping_names()));
  options.exchange_interval = table.number_or("exchange_interval", 0.0, Range::positive());
  options.kernel_width = table.number_or("kernel_width", 0.0, Range::positive());
  options.average_from = table.number_or("average_from", 0.0, Range::non_negative());
  options.series_interval = table.number_or("series_interval", 0.0, Range::positive());
  options.progress_interval = table.number_or("progress_interval", 0.0, Range::positive());
  options.case_name =
      table.text_or("case_name", std::filesystem::path(table.file()).stem().string());
  options.audit = read_audit_bounds(table.table_or_empty("audit"));
  options.monitor = read_monitor_options(table.table_or_empty("monitor"), gas_case.grid);
  table.reject_unknown_keys();
  return options;
}

}  // namespace gasgrain::coupling
