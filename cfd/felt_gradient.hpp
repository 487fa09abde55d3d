// The pressure gradient that grains feel, where it is not that of the step and the place: for light
// grains, and in intervals of several steps.
#pragma once

#include "cfd/face_medium.hpp"
#include "cfd/field.hpp"
#include "cfd/gas_domain.hpp"
#include "cfd/state_archive.hpp"

namespace gasgrain::cfd {

// m of the scheme for a density of the gas over that of the grains; 0 where it does not matter.
double lag_of(double density_ratio);

// sum of V ((1 - eps) grad p - (1 - eps_end) h) over this rank's faces, N: what the gas keeps of
// the force that the void fraction of the step would give to the grains. `felt` is h of the step.
Vec3 kept_force(const GasDomain& domain, const FaceMedium& medium, const VectorField& gradient,
                const VectorField& felt);

// Without lag (FaceMedium::lag = 0) grains feel grad p itself and nothing here is to be called.
class FeltGradient {
 public:
  explicit FeltGradient(const GasDomain& domain) : domain_(domain) {}

  // Step 2 of the scheme: what the gas keeps of the gradient of the last interval. `driving` is the
  // uniform gradient that acts with gravity, Pa/m.
  void add_held(VectorField& velocity, const FaceMedium& medium, const Vec3& driving, double dt);

  // After a step with this gradient, Pa/m, ghosts filled.
  void observe(const FaceMedium& medium, const VectorField& gradient);
  // The next step belongs to a new interval; `felt` is what grains felt in the one that ends.
  void finish_interval(const VectorField& felt) { last_ = felt; }

  // Grains that come later begin anew.
  void forget() { last_ = felt_ = {}; }

  bool is_known() const { return felt_[0].count() > 0; }  // after the first observed step
  const VectorField& value() const { return felt_; }      // h of the last observed step, Pa/m

  void visit_state(StateArchive& archive);

 private:
  void allocate();

  const GasDomain& domain_;
  VectorField last_, felt_;  // on all stored faces; empty until they are needed
};

}  // namespace gasgrain::cfd
