// The no-slip condition of bodies, imposed on the faces next to them (step 3 of the scheme).
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "cfd/face_medium.hpp"
#include "cfd/gas_domain.hpp"

namespace gasgrain::cfd {

class ImmersedBoundary {
 public:
  explicit ImmersedBoundary(const GasDomain& domain);

  // Changes the predicted velocity (ghosts filled) of the faces with 0 <= phi < dx. `dt` in s.
  // Returns the momentum that this adds to the gas of this rank, N s.
  Vec3 apply(VectorField& velocity, const GasDomain& domain, const FaceMedium& medium, double dt);

  // The same as rows of equations that are solved together (implicit_viscosity.cpp): `residual` of
  // a face becomes (1 - w) residual + w diagonal (u_IB - u) with u of `velocity` (ghosts filled).
  void constrain(VectorField& residual, const VectorField& velocity, const VectorField& diagonal,
                 const GasDomain& domain, const FaceMedium& medium) const;
  // Makes the gas of these faces 1 + w (ratio - 1) times as heavy for the pressure.
  void scale_density(FaceMedium& medium, const GasDomain& domain, double ratio) const;
  // Adds what that keeps the pressure from doing to the impulses of the last impose(). Returns the
  // sum, N s.
  Vec3 add_pressure(const VectorField& gradient, const GasDomain& domain, const FaceMedium& medium,
                    double dt);
  // Sets the predicted velocity of these faces to what was solved for, and takes the share 1 - w of
  // the old pressure, old_gradient(direction, storage index) [Pa/m], back. Returns the momentum
  // that this adds to the gas of this rank, N s.
  Vec3 impose(VectorField& velocity, const VectorField& solved,
              const std::function<double(int, std::ptrdiff_t)>& old_gradient,
              const GasDomain& domain, const FaceMedium& medium, double dt);

  // visit(direction, index of the body, position [m], momentum added to the gas by the last apply()
  // [N s]) for every face.
  template <class Visit>
  void for_each_impulse(Visit&& visit) const {
    for (int d = 0; d < 3; ++d) {
      for (const Face& face : faces_[d]) visit(d, face.body, face.position, face.impulse);
    }
  }

 private:
  struct Face {
    std::ptrdiff_t face;           // storage index
    std::ptrdiff_t base;           // lowest of the eight faces around the point x + delta n
    std::array<double, 8> weight;  // of these in u_IB; corner c is upper in direction e: c >> e & 1
    double wall_weight;            // of the wall's velocity in u_IB
    double distance;               // phi, m
    int body;                      // the nearest one
    Vec3 position;                 // of the face's centre, m
    double impulse;                // added by the last apply(), N s
  };

  void set_profile(Face& face, const GasDomain& domain, int d, const Vec3& normal) const;
  double profile(const Face& face, const Field& velocity, double wall) const;
  double weight(const Face& face, int d, const GasDomain& domain, const FaceMedium& medium) const;
  // w and u_IB of a face of direction d.
  struct Condition {
    double weight, velocity;
  };
  Condition condition(const Face& face, int d, const Field& velocity, const GasDomain& domain,
                      const FaceMedium& medium) const;

  // Momentum of the gas of a face per velocity, kg.
  static double worth(const Face& face, int d, const GasDomain& domain, const FaceMedium& medium,
                      double dt);

  double probe_length_ = 0.0;               // delta, m
  std::array<bool, 3> varies_{};            // directions to interpolate in
  std::array<std::vector<Face>, 3> faces_;  // per direction
  std::vector<double> changed_;             // velocities of the faces of one direction, m/s
};

// Sets the velocity of faces that cannot move freely inside the grid to that of the body.
void set_solid_faces(VectorField& velocity, const GasDomain& domain);

}  // namespace gasgrain::cfd
