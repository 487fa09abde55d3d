// What a GasSolver holds from step to step, and the parts of its step. For the files that implement
// it: gas_solver.cpp (the step), gas_state.cpp (walls, restarts), gas_sampling.cpp (what others
// read).
#pragma once

#include <functional>
#include <optional>

#include "cfd/body_loads.hpp"
#include "cfd/driving_gradient.hpp"
#include "cfd/face_medium.hpp"
#include "cfd/felt_gradient.hpp"
#include "cfd/gas_domain.hpp"
#include "cfd/gas_solver.hpp"
#include "cfd/immersed_boundary.hpp"
#include "cfd/implicit_viscosity.hpp"
#include "cfd/interval_means.hpp"
#include "cfd/momentum_budget.hpp"
#include "cfd/momentum_slope.hpp"
#include "cfd/projection.hpp"
#include "cfd/volume_forcing.hpp"

namespace gasgrain::cfd {

// The pressure after the first step of a run holds the impulse that made the velocity continuous;
// that after the second one is the first to stand for the next step's.
inline constexpr int settled_steps = 2;

struct GasSolver::State {
  State(const GasCase& given, MPI_Comm communicator);

  void set_velocity(const std::function<Vec3(const Vec3&)>& function);
  bool move_bodies(double new_time);  // the shape of some body has moved
  void follow_walls(const VectorField& took_part);
  void evaluate_slope();
  // Steps 1 and 2 with the two slopes by their weights. Returns the sum of |u^| over this rank's
  // faces, m/s.
  double predict(double dt, const AdamsBashforth& weights, const VectorField& now,
                 const VectorField& before);
  // The same with the stress at the end of the step.
  double predict_implicitly(StepReport& report, double dt, const AdamsBashforth& weights);
  void set_right_hand_side(VectorField& result, double dt) const;
  double old_gradient(int d, std::ptrdiff_t n) const;  // Pa/m
  Vec3 impose_bodies(double dt);                       // step 3; the momentum that it adds, N s
  // Steps 1 to 5 with the slopes at hand.
  void take_stage(StepReport& report, PassClock& clock, double dt, const AdamsBashforth& weights,
                  const Field* void_before);
  void observe_felt_gradient(MomentumBudget& budget, double dt);
  // On faces, Pa/m, in the last step.
  const VectorField& felt_gradient() const {
    return medium.lag > 0.0 && felt.is_known() ? felt.value() : projection.pressure_gradient();
  }
  void measure_loads(MomentumBudget& budget, double dt, const AdamsBashforth& weights);
  Vec3 implicit_viscous_impulse(double dt) const;
  void check_finite(double magnitudes, double dt) const;
  // Face values as the grains of a cell see them.
  void sample(VectorField& velocity, VectorField& pressure_gradient, const VectorField& u,
              const VectorField& gradient) const;
  void visit(StateArchive& archive);
  void visit_stress(StateArchive& archive);
  void visit_grains(StateArchive& archive);
  void rebuild();

  GasCase gas_case;
  GasDomain domain;
  FaceMedium medium;
  GrainPhase grains;
  ImmersedBoundary immersed_boundary;
  VolumeForcing volume_forcing;  // takes its place when the walls span bodies
  BodyLoads loads;
  UnevenCells uneven_cells;
  Projection projection;
  DrivingGradient driving;
  FeltGradient felt;  // with light grains
  VectorField velocity;
  VectorField start;           // velocity before the first stage of two
  Vec3 speeds = Vec3::Zero();  // largest |u| per direction of all ranks, m/s
  Field pressure;
  Field old_void_fraction;  // of the cells at the start of the step
  SlopeEvaluation slope_evaluation;
  MomentumSlope slope, old_slope;
  std::optional<ImplicitViscosity> implicit_viscosity;
  StressWeights stress_weights;  // of this step, with implicit viscosity
  VectorField forces;            // with implicit viscosity: sum of slopes and stresses, N/m^3
  int steps_from_start = 0;      // up to settled_steps
  std::optional<Vec3> momentum;  // of this rank's gas, while it is what the last step left, N s
  IntervalMeans means;
  double time = 0.0, previous_dt = 0.0;
  double body_clock = 0.0;                      // s, of moving bodies at time = 0
  Vec3 momentum_of_moved_walls = Vec3::Zero();  // change of this rank's gas momentum by them, N s
};

}  // namespace gasgrain::cfd
