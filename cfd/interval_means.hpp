// Velocity and pressure gradient on faces as grains feel them over several gas steps.
//
// The pressure force that a step takes from the gas and gives to the grains is (1 - eps_k) grad p_k
// per volume, with the void fraction eps_k of that step, while the grains gather with the kernel of
// the last one. The mean that makes the two equal, to round-off, is
//
//   < grad p > = sum_k dt_k (1 - eps_k) grad p_k / ( T (1 - eps_last) ),      T = sum_k dt_k.
//
// Faces without grains in the last step have the plain mean. The velocity's is plain: the drag is
// linear in it with constant coefficients.
#pragma once

#include "cfd/face_medium.hpp"
#include "cfd/field.hpp"

namespace gasgrain::cfd {

class IntervalMeans {
 public:
  void start(const Index3& block_size);
  bool started() const { return started_; }
  // After a step of length dt, s.
  void add(const FaceMedium& medium, const VectorField& velocity,
           const VectorField& pressure_gradient, double dt);
  // Turns the sums into means, on all stored faces, and ends the interval. `medium` is that of the
  // last step.
  void finish(const FaceMedium& medium);

  const VectorField& velocity() const { return velocity_; }                    // m/s
  const VectorField& pressure_gradient() const { return pressure_gradient_; }  // Pa/m

 private:
  bool started_ = false;
  double duration_ = 0.0;  // s
  VectorField velocity_, pressure_gradient_, weighted_gradient_;
};

}  // namespace gasgrain::cfd
