// The numbers of an exchange: sums and extremes over grains and ranks, and the residuals of what
// must hold exactly (solid volume, Newton's third law).
#include "coupling/exchange_report.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cfd/loops.hpp"
#include "coupling/gas_coupling.hpp"

namespace gasgrain::coupling {

namespace {

constexpr double alone = 0.99;        // void fraction
constexpr double motion_share = 0.1;  // of a diameter or spacing per interval
constexpr double infinity = std::numeric_limits<double>::infinity();

// Sums over all ranks: add() before, reduce() once, then take() in the same order.
class Sums {
 public:
  void add(double value) { values_.push_back(value); }
  void add(const Vec3& value) {
    for (int d = 0; d < 3; ++d) add(value[d]);
  }
  void reduce(MPI_Op operation, MPI_Comm communicator) {
    MPI_Allreduce(MPI_IN_PLACE, values_.data(), static_cast<int>(values_.size()), MPI_DOUBLE,
                  operation, communicator);
  }
  double take() { return values_[next_++]; }
  Vec3 take_vector() {
    const double x = take(), y = take(), z = take();
    return {x, y, z};
  }

 private:
  std::vector<double> values_;
  std::size_t next_ = 0;
};

double relative(double residual, double magnitude) {
  return magnitude > 0 ? residual / magnitude : residual;
}

}  // namespace

void add(cfd::MomentumBudget& sum, const cfd::MomentumBudget& budget) {
  for (const MomentumRow row : momentum_rows) sum.*row += budget.*row;
}

// Of this rank's walls.
double GasCoupling::wall_motion_limit() const {
  if (!gas_.has_motion()) return infinity;
  double fastest = 0.0;
  for (const cfd::Field& velocity : gas_.walls().wall_velocity) {
    for (std::size_t n = 0; n < velocity.count(); ++n)
      fastest = std::max(fastest, std::abs(velocity[static_cast<std::ptrdiff_t>(n)]));
  }
  const double least = gas_.decomposition().grid().spacing().minCoeff();
  return fastest > 0 ? motion_share * least / fastest : infinity;
}

void GasCoupling::measure(double interval) {
  const std::vector<GrainRecord>& grains = transfer_.received();
  const MPI_Comm communicator = gas_.decomposition().communicator();
  double inside = 0, lone = 0, volume = 0, mass = 0, drag_size = 0, pressure_size = 0;
  Vec3 drag = Vec3::Zero(), carried = Vec3::Zero(), pressure = Vec3::Zero();
  IntervalLimits limits{infinity, infinity, wall_motion_limit(), infinity};
  for (std::size_t n = 0; n < grains.size(); ++n) {
    if (!deposition_.takes_part(n)) continue;
    const GrainRecord& grain = grains[n];
    inside += 1;
    if (void_fractions_[n] > alone) lone += 1;
    volume += grain.volume;
    mass += grain.mass;
    drag += drag_[n];
    pressure += pressure_[n];
    carried += grain.carried;
    drag_size += drag_[n].norm();
    pressure_size += pressure_[n].norm();
    const double speed = grain.velocity.norm();
    if (speed > 0) {
      limits.grain_motion =
          std::min(limits.grain_motion, motion_share * grain_diameter(grain) / speed);
    }
    limits.exchange = std::min(
        limits.exchange, stable_exchange_interval(grain, void_fractions_[n], coefficients_[n]));
  }
  double deposited = 0;
  cfd::for_each_cell(void_fraction_.size(), [&](int i, int j, int k) {
    const std::ptrdiff_t n = void_fraction_.index(i, j, k);
    deposited += deposition_.open_fraction()[n] * (1.0 - void_fraction_[n]);
  });
  deposited *= gas_.decomposition().grid().cell_volume();

  Sums sums, least;
  const double outside = double(transfer_.outside()) + (double(grains.size()) - inside);
  for (double value : {inside, outside, lone, double(report_.limited), volume, mass, deposited,
                       drag_size, pressure_size}) {
    sums.add(value);
  }
  for (const Vec3& value : {drag, pressure, carried, report_.drag_on_walls}) sums.add(value);
  sums.reduce(MPI_SUM, communicator);
  for (double value : {limits.grain_motion, limits.exchange, limits.wall_motion}) least.add(value);
  least.reduce(MPI_MIN, communicator);

  report_.grains_inside = std::lround(sums.take());
  report_.grains_outside = std::lround(sums.take());
  report_.grains_alone = std::lround(sums.take());
  report_.limited = std::lround(sums.take());
  report_.solid_volume = sums.take();
  report_.solid_mass = sums.take();
  deposited = sums.take();
  drag_size = sums.take();
  pressure_size = sums.take();
  drag = sums.take_vector();
  pressure = sums.take_vector();
  carried = sums.take_vector();
  report_.drag_on_walls = sums.take_vector();
  report_.force_on_grains = drag + pressure;
  report_.limits.grain_motion = least.take();
  report_.limits.exchange = least.take();
  report_.limits.wall_motion = least.take();
  report_.limits.gas = gas_.largest_stable_step();
  if (options_.feedback == Feedback::one_way) return;
  report_.solid_volume_residual =
      relative(std::abs(deposited - report_.solid_volume), report_.solid_volume);
  if (interval <= 0) return;
  const cfd::MomentumBudget& gas = report_.gas_momentum;
  report_.carried = carried;
  report_.unbalanced = interval * drag + carried + gas.drag + report_.drag_on_walls;
  report_.drag_impulse = interval * drag_size;
  report_.third_law_residual = relative(report_.unbalanced.norm(), report_.drag_impulse);
  report_.pressure_residual =
      relative((interval * pressure - gas.pressure_on_grains).norm(), interval * pressure_size);
}

}  // namespace gasgrain::coupling
