#include "cfd/interval_means.hpp"

namespace gasgrain::cfd {

namespace {

constexpr double some_solid = 1e-12;  // solid fraction below which a face has no grains

}  // namespace

void IntervalMeans::start(const Index3& block_size) {
  started_ = true;
  duration_ = 0.0;
  for (VectorField* field : {&velocity_, &pressure_gradient_, &weighted_gradient_}) {
    for (int d = 0; d < 3; ++d) {
      if ((*field)[d].count() == 0) (*field)[d] = Field(block_size);
      (*field)[d].fill(0.0);
    }
  }
}

void IntervalMeans::add(const FaceMedium& medium, const VectorField& velocity,
                        const VectorField& pressure_gradient, double dt) {
  duration_ += dt;
  for (int d = 0; d < 3; ++d) {
    const double* eps = medium.void_fraction[d].data();
    const double* u = velocity[d].data();
    const double* gradient = pressure_gradient[d].data();
    double* mean = velocity_[d].data();
    double* plain = pressure_gradient_[d].data();
    double* weighted = weighted_gradient_[d].data();
    const std::size_t count = velocity[d].count();
    for (std::size_t n = 0; n < count; ++n) {
      mean[n] += dt * u[n];
      plain[n] += dt * gradient[n];
      if (medium.has_grains) weighted[n] += dt * (1.0 - eps[n]) * gradient[n];
    }
  }
}

void IntervalMeans::finish(const FaceMedium& medium) {
  started_ = false;
  const double share = 1.0 / duration_;
  for (int d = 0; d < 3; ++d) {
    const std::size_t count = velocity_[d].count();
    for (std::size_t n = 0; n < count; ++n) {
      velocity_[d][n] *= share;
      const double solid = medium.has_grains ? 1.0 - medium.void_fraction[d][n] : 0.0;
      pressure_gradient_[d][n] = solid > some_solid ? share * weighted_gradient_[d][n] / solid
                                                    : share * pressure_gradient_[d][n];
    }
  }
}

}  // namespace gasgrain::cfd
