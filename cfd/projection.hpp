// Steps 4 and 5 of the scheme: the pressure that makes the predicted velocity continuous.
#pragma once

#include <memory>

#include "cfd/face_medium.hpp"
#include "cfd/gas_domain.hpp"
#include "cfd/gas_regions.hpp"
#include "cfd/pressure_solver.hpp"

namespace gasgrain::cfd {

class Projection {
 public:
  struct Report {
    PressureReport solve;
    double removed_mean = 0.0;     // largest of the singular regions, relative to the 1-norm of the
                                   // right-hand side's terms
    double swept_imbalance = 0.0;  // largest of the singular regions: volume that moving bodies
                                   // leave to it minus what they take, over the sum of both
  };

  Projection(const GasDomain& domain, const Numerics& numerics);

  // Looks for the connected regions of gas; again after the walls of the domain changed.
  // Collective.
  void find_regions();

  // Solves for `pressure` (first guess in, ghosts filled out). `velocity` is u* with ghosts filled;
  // `old_void_fraction` is eps of the cells at the start of the step. Throws UserError when the
  // tolerance is missed or a region without outlet would have to gain or lose gas.
  Report solve(const FaceMedium& medium, const Field& old_void_fraction,
               const VectorField& velocity, double dt, Field& pressure);

  // u = u* - (c/eps) grad p on the faces that take part.
  void correct(VectorField& velocity, const FaceMedium& medium, double dt) const;

  // Goes on from a pressure of an earlier run, ghosts filled.
  void restore(const Field& pressure) { set_gradient(pressure); }

  // grad p on faces, Pa/m, 0 on those that do not take part; ghosts filled. Of the last solve() or
  // restore().
  const VectorField& pressure_gradient() const { return gradient_; }

  // Largest |change of the void + dt * outflow| of a cell over its void. Collective.
  double divergence(const FaceMedium& medium, const Field& old_void_fraction,
                    const VectorField& velocity, double dt) const;

 private:
  void set_coefficients(const FaceMedium& medium, double dt);
  void set_right_hand_side(const FaceMedium& medium, const Field& old_void_fraction,
                           const VectorField& velocity, double dt);
  void add_outlets();
  double remove_means(double dt);
  double balance_swept_volume();
  void remove_pressure_means(Field& pressure);
  void check(const PressureReport& report) const;
  void set_gradient(const Field& pressure);

  const GasDomain& domain_;
  double tolerance_;
  int max_iterations_;
  std::unique_ptr<PressureSolver> solver_;
  PressureSystem system_;
  Field term_norm_;    // sum of |terms| of the right-hand side per cell
  Field outlet_term_;  // coefficient times pressure of the outlets, m^3/s
  GasRegions regions_;
  std::vector<double> region_means_, region_sums_, region_norms_, region_volumes_;
  Field swept_;  // volume that moving bodies leave to each cell, balanced, m^3/s
  VectorField gradient_;
};

}  // namespace gasgrain::cfd
