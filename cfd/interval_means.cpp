#include "cfd/interval_means.hpp"

namespace gasgrain::cfd {

void IntervalMeans::start(const Index3& block_size) {
  started_ = true;
  duration_ = 0.0;
  for (VectorField* field : {&velocity_, &pressure_gradient_}) {
    for (Field& component : *field) {
      if (component.count() == 0) component = Field(block_size);
      component.fill(0.0);
    }
  }
}

void IntervalMeans::add(const VectorField& velocity, const VectorField& pressure_gradient,
                        double dt) {
  duration_ += dt;
  for (int d = 0; d < 3; ++d) {
    const double* u = velocity[d].data();
    const double* gradient = pressure_gradient[d].data();
    double* mean = velocity_[d].data();
    double* mean_gradient = pressure_gradient_[d].data();
    const std::size_t count = velocity[d].count();
    for (std::size_t n = 0; n < count; ++n) {
      mean[n] += dt * u[n];
      mean_gradient[n] += dt * gradient[n];
    }
  }
}

void IntervalMeans::finish() {
  started_ = false;
  const double share = 1.0 / duration_;
  for (int d = 0; d < 3; ++d) {
    const std::size_t count = velocity_[d].count();
    for (std::size_t n = 0; n < count; ++n) {
      velocity_[d][n] *= share;
      pressure_gradient_[d][n] *= share;
    }
  }
}

}  // namespace gasgrain::cfd
