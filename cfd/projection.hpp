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
  // Largest of the regions without outlet.
  struct Balance {
    double removed_mean = 0.0;     // of the right-hand side, relative to the 1-norm of its terms
    double swept_imbalance = 0.0;  // volume that moving bodies leave to the region minus what they
                                   // take, over the sum of both
  };

  Projection(const GasDomain& domain, const Numerics& numerics);

  // After the walls of the domain changed: regions of gas are found anew, and the gradient of
  // `pressure` (ghosts filled) on the faces that take part and did so before. Collective.
  void follow_walls(const Field& pressure, const VectorField& took_part);

  // Coefficients and right-hand side of the pressure equation. `velocity` is u* with ghosts filled;
  // `old_void_fraction` is eps of the cells at the start of the step, null when there were no
  // grains then and there are none now. Throws UserError when a region without outlet would have
  // to gain or lose gas.
  Balance set_equation(const FaceMedium& medium, const Field* old_void_fraction,
                       const VectorField& velocity, double dt);

  // Solves for `pressure` (first guess in, ghosts filled out). Throws UserError when the tolerance
  // is missed.
  PressureReport solve(Field& pressure);

  // u = u* - (c/eps) grad p on the faces that take part; the mean of p becomes 0 in regions without
  // outlet. Returns the sum of |u| over this rank's faces, m/s.
  double correct(VectorField& velocity, Field& pressure, const FaceMedium& medium, double dt);

  // Goes on from a pressure of an earlier run, ghosts filled.
  void restore(const Field& pressure) { set_gradient(pressure); }

  // grad p on faces, Pa/m, 0 on those that do not take part; ghosts filled. Of the last correct()
  // or restore().
  const VectorField& pressure_gradient() const { return gradient_; }
  VectorField& pressure_gradient() { return gradient_; }

  const GasRegions& regions() const { return regions_; }

  // Largest |change of the void + dt * outflow| of a cell over its void. Collective.
  double divergence(const FaceMedium& medium, const Field* old_void_fraction,
                    const VectorField& velocity, double dt);

 private:
  void find_regions();
  void set_coefficients(const FaceMedium& medium, double dt);
  template <class Faces>
  void set_coefficients_along(int d, const Faces& faces);
  void set_right_hand_side(const FaceMedium& medium, const Field* old_void_fraction,
                           const VectorField& velocity, double dt);
  void add_outlets();
  double remove_means(double dt);
  void clear_round_off();
  double balance_swept_volume();
  void set_pressure_means(Field& pressure, double reference);
  void check(const PressureReport& report) const;
  void set_gradient(const Field& pressure);
  template <class Follow>
  void set_gradient(const Field& pressure, const Follow& follow);

  // What the pressure behind an outlet adds to the right-hand side of a cell.
  struct OutletTerm {
    std::ptrdiff_t cell;  // storage index
    double value;         // m^3/s
  };

  const GasDomain& domain_;
  double tolerance_;
  int max_iterations_;
  double reference_;  // Pa
  std::unique_ptr<PressureSolver> solver_;
  PressureSystem system_;
  Field term_norm_;   // sum of |terms| of the right-hand side per cell
  Field divergence_;  // change of the void + dt * outflow per cell volume
  std::vector<OutletTerm> outlet_terms_;
  std::vector<std::ptrdiff_t> closed_cells_;  // storage indices: no open face, no equation
  GasRegions regions_;
  std::vector<double> region_means_, region_sums_, region_norms_, region_volumes_;
  Field swept_;  // volume that moving bodies leave to each cell, balanced, m^3/s
  VectorField gradient_;
};

}  // namespace gasgrain::cfd
