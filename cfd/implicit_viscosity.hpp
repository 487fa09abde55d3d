// Viscous stress at the end of the step instead of its start: numerics.viscosity = "implicit".
#pragma once

#include "cfd/face_medium.hpp"
#include "cfd/gas_domain.hpp"
#include "cfd/immersed_boundary.hpp"

namespace gasgrain::cfd {

// Shares of the stress at the end of the step, at its start and at the start of the one before.
struct StressWeights {
  double coming = 1.0;
  double now = 0.0;
  double before = 0.0;
};

// `previous_dt` = 0 for the first step, which is Euler's. See implicit_viscosity.cpp.
StressWeights stress_weights(double dt, double previous_dt);

class ImplicitViscosity {
 public:
  explicit ImplicitViscosity(const GasDomain& domain);

  struct Step {
    double dt;      // s
    double coming;  // share of the stress that is solved for
  };

  // Right-hand side of the next solve() on faces, kg m^-2 s^-1: the momentum of the gas there after
  // all forces of the step but the stress that is solved for and the drag that u = 0 would not
  // have.
  VectorField& right_hand_side() { return right_hand_side_; }

  // Solves (eps rho + dt B) v - dt coming div(eps tau(v)) = right-hand side on the faces that take
  // part, with the condition of `boundary` next to bodies. `velocity` (walls of the end of the
  // step) is the first guess and gives the other faces. Returns the number of iterations. Throws
  // SolveFailure when the tolerance is missed. Collective.
  int solve(const VectorField& velocity, const FaceMedium& medium, const ImmersedBoundary& boundary,
            const Step& step);

  const VectorField& velocity() const { return velocity_; }  // v with ghosts filled, m/s
  const VectorField& stress() const { return stress_; }      // div(eps tau(v)) on faces, N/m^3

 private:
  struct Equation;
  void set_diagonal(const Equation& equation);
  // `given` minus the left-hand side for `velocity`, whose ghosts it fills, on the faces that take
  // part; 0 elsewhere. Leaves the stress of `velocity` in stress_.
  void evaluate_residual(VectorField& residual, VectorField& velocity, const Equation& equation,
                         const VectorField& given);
  // The left-hand side without what sides, inlets and bodies give.
  void apply(VectorField& image, VectorField& argument, const Equation& equation);
  // result = a / diagonal
  void scale(VectorField& result, const VectorField& a);
  int iterate(const Equation& equation, double target, int most);
  double product(const VectorField& a, const VectorField& b) const;
  double norm(const VectorField& a) const;
  template <class Visit>
  void for_each_component(const Visit& visit) const;

  const GasDomain& domain_;
  VectorField right_hand_side_, velocity_, stress_;
  VectorField nothing_;   // zero right-hand side
  VectorField at_rest_;   // residual of v = 0 without right-hand side
  VectorField diagonal_;  // of the rows, kg/m^3
  VectorField residual_, shadow_, direction_, direction_image_, scaled_, image_;
};

}  // namespace gasgrain::cfd
