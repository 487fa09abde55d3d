// Velocity and pressure gradient on faces as grains feel them: means over the gas steps of an
// interval.
#pragma once

#include "cfd/field.hpp"

namespace gasgrain::cfd {

class IntervalMeans {
 public:
  void start(const Index3& block_size);
  bool started() const { return started_; }
  // After a step of length dt, s.
  void add(const VectorField& velocity, const VectorField& pressure_gradient, double dt);
  // Turns the sums into means, on all stored faces, and ends the interval.
  void finish();

  const VectorField& velocity() const { return velocity_; }                    // m/s
  const VectorField& pressure_gradient() const { return pressure_gradient_; }  // Pa/m

 private:
  bool started_ = false;
  double duration_ = 0.0;  // s
  VectorField velocity_, pressure_gradient_;
};

}  // namespace gasgrain::cfd
