// The mean pressure gradient of periodic directions: given, or what a given mean flow needs.
#pragma once

#include <string>

#include "cfd/face_medium.hpp"
#include "cfd/gas_domain.hpp"

namespace gasgrain::cfd {

class DrivingGradient {
 public:
  explicit DrivingGradient(const GasDomain& domain);

  bool present() const { return present_; }
  // Pa/m; acts on the gas and on the grains in it like any pressure gradient.
  const Vec3& value() const { return value_; }

  // The numbers that a restarted run needs: number(name, value) for each.
  template <class Number>
  void visit(Number&& number) {
    for (int d = 0; d < 3; ++d) {
      number(std::string("driving_gradient_") + "xyz"[d], value_[d]);
      number(std::string("driving_offset_") + "xyz"[d], offset_[d]);
    }
  }

  // Changes the predicted velocity (on faces that take part) and the gradient so that the mean
  // superficial velocity of each direction with a prescribed flow is the one wanted. Collective.
  void keep_mean_flow(VectorField& velocity, const FaceMedium& medium, double dt);

  // Looks at the flow after the step, m/s of mean superficial velocity. Collective.
  void observe(const VectorField& velocity, const FaceMedium& medium);

  // Adds the gradient to the faces that take part, ghosts included.
  void add_to(VectorField& pressure_gradient) const;

 private:
  double mean_flow(const VectorField& velocity, const FaceMedium& medium, int d) const;

  const GasDomain& domain_;
  bool present_ = false;
  Vec3 value_ = Vec3::Zero();
  std::array<bool, 3> flow_is_given_{};
  Vec3 mean_velocity_ = Vec3::Zero();  // superficial, m/s
  Vec3 offset_ = Vec3::Zero();         // m/s
};

}  // namespace gasgrain::cfd
