// Bodies as the paper imposes them, for comparison: step 3 of the scheme by volume fractions.
#pragma once

#include <vector>

#include "cfd/face_medium.hpp"
#include "cfd/gas_domain.hpp"

namespace gasgrain::cfd {

class VolumeForcing {
 public:
  // Without faces unless the walls of the domain span its bodies.
  explicit VolumeForcing(const GasDomain& domain);

  // Changes the predicted velocity of the faces whose volume bodies share. `dt` in s. Returns the
  // momentum that this adds to the gas of this rank, N s.
  Vec3 apply(VectorField& velocity, const GasDomain& domain, const FaceMedium& medium, double dt);

  // What the density scaling held back of the impulse of the pressure, whose gradient [Pa/m] the
  // correction has just used; N s of this rank.
  Vec3 add_pressure(const VectorField& gradient, const GasDomain& domain, const FaceMedium& medium,
                    double dt);

  // visit(direction, index of the body, position [m], momentum added to the gas by the last apply()
  // and add_pressure() [N s]) for every face.
  template <class Visit>
  void for_each_impulse(Visit&& visit) const {
    for (int d = 0; d < 3; ++d) {
      for (const Face& face : faces_[d]) visit(d, face.body, face.position, face.impulse);
    }
  }

 private:
  struct Face {
    std::ptrdiff_t face;  // storage index
    double solid_share;   // alpha_f
    int body;             // the nearest one
    Vec3 position;        // of the face's centre, m
    double impulse;       // N s
  };

  std::array<std::vector<Face>, 3> faces_;  // per direction
};

}  // namespace gasgrain::cfd
