#include "cfd/time_series.hpp"

#include <iomanip>
#include <limits>

#include "coupling/files/collective_error.hpp"

namespace gasgrain::cfd {

namespace {

constexpr const char* side_names[3][2] = {
    {"x_lower", "x_upper"}, {"y_lower", "y_upper"}, {"z_lower", "z_upper"}};

// visit(direction, side) for the sides that gas can cross or press on; one of a periodic pair.
template <class Visit>
void for_each_side(const GasSolver& solver, Visit&& visit) {
  for (int d = 0; d < 3; ++d) {
    const bool periodic = solver.decomposition().periodic()[d];
    for (int side = 0; side < (periodic ? 1 : 2); ++side) visit(d, side);
  }
}

}  // namespace

TimeSeries::TimeSeries(const std::string& path, const GasSolver& solver) {
  run_collectively(solver.decomposition().communicator(), [&] {
    if (solver.decomposition().rank() != 0) return;
    file_.open(path);
    file_ << "time_s,step_s,courant_number,pressure_iterations,pressure_residual,"
             "divergence,removed_mean,largest_speed_m_s";
    for_each_side(solver, [&](int d, int side) {
      if (!solver.decomposition().periodic()[d])
        file_ << "," << side_names[d][side] << "_pressure_Pa";
      file_ << "," << side_names[d][side] << "_flux_m3_s";
    });
    file_ << "\n" << std::setprecision(std::numeric_limits<double>::max_digits10) << std::flush;
    if (!file_) {
      throw UserError("cannot write '" + path + "'; check output.directory or --out");
    }
  });
}

void TimeSeries::write(const GasSolver& solver, const StepReport& report, double dt) {
  file_ << solver.time() << "," << dt << "," << report.courant_number << ","
        << report.pressure.iterations << "," << report.pressure.residual << "," << report.divergence
        << "," << report.removed_mean << "," << report.largest_speed;
  for_each_side(solver, [&](int d, int side) {
    if (!solver.decomposition().periodic()[d]) file_ << "," << solver.side_pressure(d, side);
    file_ << "," << solver.side_flux(d, side);
  });
  file_ << "\n";
}

}  // namespace gasgrain::cfd
