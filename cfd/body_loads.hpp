// Force and torque of the gas on each body.
#pragma once

#include <vector>

#include "cfd/body_load.hpp"
#include "cfd/gas_domain.hpp"
#include "cfd/immersed_boundary.hpp"

namespace gasgrain::cfd {

class BodyLoads {
 public:
  explicit BodyLoads(const GasDomain& domain);

  // Looks for the cells and faces that bodies act on; again after the walls of the domain changed.
  void find_walls();

  // Starts a step with what `boundary`, an ImmersedBoundary or a VolumeForcing, has just done.
  template <class BodyBoundary>
  void start(const BodyBoundary& boundary) {
    clear();
    boundary.for_each_impulse([&](int d, int body, const Vec3& position, double impulse) {
      const Vec3 received = -impulse * Vec3::Unit(d);
      loads_[body].friction += received;
      loads_[body].friction_torque += (position - reference_[body]).cross(received);
    });
  }
  // Adds what the stress of the gas does to the volume of the bodies: `weight` * slope on faces,
  // N/m^3 times s. The slope must be that of all faces, also of those that do not take part.
  void add_stress(const VectorField& slope, double weight);
  // `uniform_gradient` [Pa/m]: of the pressure of periodic directions, beside `pressure`.
  void add_pressure(const Field& pressure, const VectorField& gradient,
                    const Vec3& uniform_gradient, double dt);
  // Divides by dt and sums over ranks. Collective.
  void finish(double dt);

  // One per body of the case, in its order; zero for bodies that do not act on the gas.
  const std::vector<BodyLoad>& loads() const { return loads_; }
  // Sum over the bodies of this rank before finish(): momentum given to them by stress, N s.
  const Vec3& stress_impulse() const { return stress_impulse_; }

 private:
  void clear();

  // A cell whose control volumes a body changes, or a face where it does.
  struct Cell {
    Index3 local;
    int body;
    Vec3 arm;  // from the torque point to the surface next to it, m
    // Control volume that the body takes from its lower and upper face of each direction, m^3.
    Vec3 missing_below = Vec3::Zero(), missing_above = Vec3::Zero();
  };
  struct Face {
    std::ptrdiff_t face;
    int body;
    double missing;  // control volume that the body takes away, m^3
    Vec3 arm;        // m
  };

  double undisturbed_volume(int d, const Index3& local) const;
  Vec3 pressure_on(const Cell& cell, const Field& pressure, const VectorField& gradient) const;
  double side_term(int d, int side, const Index3& local, const Field& pressure,
                   const VectorField& gradient) const;

  const GasDomain& domain_;
  std::vector<Cell> cells_;
  std::array<std::vector<Face>, 3> faces_;
  std::vector<BodyLoad> loads_;
  std::vector<double> sums_;     // of all loads, over the ranks
  std::vector<Vec3> reference_;  // torque points of the bodies, m
  Vec3 stress_impulse_ = Vec3::Zero();
};

}  // namespace gasgrain::cfd
