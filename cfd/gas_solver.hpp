// Volume-averaged Navier-Stokes equations (model A) on a staggered grid with grains as a porous,
// dragging phase and SDF bodies as walls. The algorithm and its sources: cfd/gas_solver.cpp.
//
// Protocol: construct (UserError: the case cannot be solved, see GasDomain and check_boundaries());
// then for each step set grains() (skip it when nothing moved) and call advance(). All collective.
#pragma once

#include <functional>
#include <memory>

#include "cfd/body_load.hpp"
#include "cfd/field.hpp"
#include "cfd/gas_case.hpp"
#include "cfd/grid.hpp"
#include "cfd/pass_times.hpp"
#include "cfd/pressure_solver.hpp"
#include "cfd/side_conditions.hpp"
#include "cfd/state_archive.hpp"
#include "cfd/time_step.hpp"
#include "cfd/wall_geometry.hpp"

namespace gasgrain::cfd {

// What the grains do to the gas, in owned cells, per open volume (1 - alpha) V of the cell. The
// solver fills ghosts itself.
struct GrainPhase {
  Field void_fraction;      // eps at the end of the coming step, in (0, 1]
  Field momentum_exchange;  // B, kg m^-3 s^-1: sum over grains of weight * coefficient / volume
  VectorField exchange_momentum;  // B v, kg m^-2 s^-2: the same with the grains' velocities (cells)
  // Density of the gas over that of the lightest grains, -; from 0.01 on the force of the displaced
  // gas is made implicit (cfd/felt_gradient.cpp). A new interval of the grains' motion begins at
  // every step, or at start_means() when it has several.
  double density_ratio = 0.0;
};

// Momentum that entered the gas during the last advance(), by cause; N s, summed over all ranks.
// stored = pressure + gravity + convection + viscous + drag + body, up to round-off.
// A face's control volume is the sum of its cells' shares (WallGeometry), so that the pressure row
// is the integral of -grad p over the gas AND the grains' volume minus `pressure_on_grains`.
struct MomentumBudget {
  Vec3 stored = Vec3::Zero();              // change of sum eps rho u V
  Vec3 pressure = Vec3::Zero();            // -eps grad p
  Vec3 pressure_on_grains = Vec3::Zero();  // -(1-eps) grad p: what the grains receive
  Vec3 gravity = Vec3::Zero();             // eps rho g
  Vec3 convection = Vec3::Zero();          // boundary flux and remainder of the advective form
  Vec3 viscous = Vec3::Zero();             // shear of sides; interior terms cancel
  Vec3 drag = Vec3::Zero();                // -(what the grains receive by drag)
  Vec3 body = Vec3::Zero();                // immersed bodies: what step 3 of the scheme adds
  // pressure + pressure_on_grains = side_pressure + body_pressure, computed independently from the
  // cells' pressures: the force of the sides of the grid on gas and grains, and that of the bodies.
  Vec3 side_pressure = Vec3::Zero();
  Vec3 body_pressure = Vec3::Zero();
  Vec3 body_stress =
      Vec3::Zero();  // share of convection and viscous that passes the surface of
                     // bodies: -(body + body_pressure + body_stress)/dt is their load
};

struct StepReport {
  PressureReport pressure;       // iterations, residual
  double divergence = 0.0;       // largest |continuity residual| * dt, relative to eps (-)
  double removed_mean = 0.0;     // of the pressure right-hand side, relative to the 1-norm of its
                                 // terms; 0 when the system is not singular
  int viscous_iterations = 0;    // of implicit viscosity
  double swept_imbalance = 0.0;  // of sealed regions: net volume that moving bodies leave over what
                                 // they leave and take (-); evened out, see Projection
  double backflow = 0.0;         // m^3/s that enter through outlets after the step
  Vec3 driving_gradient = Vec3::Zero();  // Pa/m, mean of periodic directions
  double courant_number = 0.0;           // largest |u| dt / dx after the step
  double largest_speed = 0.0;            // largest velocity component after the step, m/s
  MomentumBudget momentum;
  PassTimes times;  // of this rank; for display, they decide nothing
};

class GasSolver {
 public:
  GasSolver(const GasCase& gas_case, MPI_Comm communicator);
  ~GasSolver();

  const GasCase& gas_case() const;
  const Decomposition& decomposition() const;
  const WallGeometry& walls() const;
  const std::vector<SidePart>& side_parts() const;  // of the sides of the grid, then the patches
  bool has_motion() const;                          // some body that acts on the gas ever moves

  // Sets the velocity of all faces that take part from a function of position, m/s; the next step
  // is the first of a run (Euler's). At construction the case's initial velocity is set.
  void set_velocity(const std::function<Vec3(const Vec3&)>& velocity);

  // To be set before advance(); persists between steps.
  GrainPhase& grains();
  // Makes the void fraction of grains() also the one at the start of the coming step: at the very
  // first exchange, when grains appear without displacing gas.
  void accept_void_fraction_as_old();

  // The clock of moving bodies shows `clock` [s] when time() is 0 (default 0). Before the first
  // step. Collective.
  void set_body_clock(double clock);

  // Moves the bodies to where they are at `time` [s], not before time(). advance() does this itself
  // for the end of its step; call it when the walls must be known before the grains are mapped. The
  // void fraction of grains() is then per the new open volume, with the same solid volume.
  // Returns true when some shape has another place now. Collective.
  bool move_bodies(double time);

  // One step of dt [s]. Throws UserError when the pressure solve fails or the velocity is no longer
  // finite; the message says the time, the largest velocity and the step.
  StepReport advance(double dt);

  // Largest step that the viscous and Courant limits and numerics.largest_step allow now, s.
  double largest_stable_step() const;
  StepLimits step_limits() const;  // the same by cause
  double time() const;             // s

  // Saves or restores all that enters later steps. Of grains(), what the last advance() or
  // accept_void_fraction_as_old() was given belongs to it: call this before setting them anew. A
  // solver that restores must be of the same case, on any number of ranks.
  void visit_state(StateArchive& archive);

  // Force and torque on every body of the case, in its order, during the last advance(): means over
  // the step, all ranks.
  const std::vector<BodyLoad>& body_loads() const;

  const VectorField& velocity() const;  // u on faces, m/s (interstitial)
  const Field& pressure() const;        // p in cells, Pa
  const Field& void_fraction() const;   // eps in cells, ghosts filled

  // Gas as the grains of a cell see it, with the pressure gradient that they feel: sum of
  // lower_share and upper_share times the face value. The transpose of the way B, B v and the solid
  // volume reach the faces, so that a grain and the gas exchange opposite forces. In directions
  // without a free face: the wall's velocity and 0. Ghosts are filled as by fill_ghosts.
  void sample_at_cells(VectorField& velocity, VectorField& pressure_gradient) const;
  // The same for an interval of several steps: start_means() with the cells' void fraction at the
  // end of the last step, the steps, sample_means_at_cells(): means over the steps, and the force
  // on grains in their last places is what the gas has felt (cfd/felt_gradient.cpp).
  void start_means(const Field& void_fraction_at_end);
  void sample_means_at_cells(VectorField& velocity, VectorField& pressure_gradient);
  // div(eps tau) of the velocities after the last step, N/m^3, sampled as the pressure gradient.
  void sample_viscous_force_at_cells(VectorField& force) const;

  // Mean pressure over the open area of a side of the grid that is not periodic, Pa, extrapolated
  // from the control volumes of the faces next to it so that the momentum balance closes.
  double side_pressure(int direction, int side) const;
  double side_open_area(int direction, int side) const;  // m^2 that no body covers
  double side_flux(int direction, int side) const;       // m^3/s of gas, positive along +direction
  // The same through a plane of faces (0 to the number of cells along the direction), of this
  // rank's faces only.
  double plane_flux(int direction, int plane) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace gasgrain::cfd
