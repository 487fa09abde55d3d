#include "cfd/time_series.hpp"

#include <vector>

#include "cfd/side_states.hpp"
#include "coupling/files/collective_error.hpp"

namespace gasgrain::cfd {

TimeSeries::TimeSeries(const std::string& path, const GasSolver& solver,
                       std::optional<double> continue_from) {
  std::vector<std::string> columns{
      "time_s",     "step_s",       "courant_number",   "pressure_iterations", "pressure_residual",
      "divergence", "removed_mean", "largest_speed_m_s"};
  if (solver.has_motion()) columns.push_back("swept_imbalance");
  for (const SideState& side : side_states(solver)) {
    if (!side.periodic) columns.push_back(side.name + "_pressure_Pa");
    columns.push_back(side.name + "_flux_m3_s");
  }
  run_collectively(solver.decomposition().communicator(), [&] {
    if (solver.decomposition().rank() == 0) file_.emplace(path, columns, continue_from);
  });
}

void TimeSeries::write(const GasSolver& solver, const StepReport& report, double dt) {
  std::vector<double> row{solver.time(),
                          dt,
                          report.courant_number,
                          double(report.pressure.iterations),
                          report.pressure.residual,
                          report.divergence,
                          report.removed_mean,
                          report.largest_speed};
  if (solver.has_motion()) row.push_back(report.swept_imbalance);
  for (const SideState& side : side_states(solver)) {
    if (!side.periodic) row.push_back(side.pressure);
    row.push_back(side.flux);
  }
  if (file_) file_->add(row);
}

void TimeSeries::flush() {
  if (file_) file_->flush();
}

}  // namespace gasgrain::cfd
