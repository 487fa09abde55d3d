// The bracket of step 1 of the scheme (gas_solver.cpp): convection and viscous stress on faces.
#pragma once

#include <vector>

#include "cfd/convection.hpp"

namespace gasgrain::cfd {

// At one time, with its integrals over the control volumes of this rank.
struct MomentumSlope {
  VectorField total;               // N/m^3 on faces; without the stress when that is kept apart
  VectorField stress;              // N/m^3 on faces; empty unless it is kept apart
  Vec3 convection = Vec3::Zero();  // N
  Vec3 viscous = Vec3::Zero();     // N
};

class SlopeEvaluation {
 public:
  SlopeEvaluation(const GasDomain& domain, Convection scheme);

  // `velocity` with ghosts filled. The fields of `slope` have the size of the block; a field for
  // the stress keeps it apart.
  void evaluate(MomentumSlope& slope, const FaceMedium& medium, const VectorField& velocity);

 private:
  // What passes the sides of control volumes across one direction, each side at the index of the
  // face above it minus the index of the work space's first face.
  struct Sides {
    std::vector<double> flux;     // F, m/s
    std::vector<double> carried;  // u that F carries, m/s
    std::vector<double> stress;   // eps tau over the spacing, N/m^3
  };
  // Faces of component d in one plane across z.
  struct Part {
    int d;
    IndexBox box;
    std::ptrdiff_t plane;  // storage index of the first face of the plane
  };

  template <class Scheme>
  void add_changes(const Part& part, const FaceMedium& medium, const VectorField& velocity);
  template <class TransportOf, class Stress>
  void add_change(const Part& part, int e, const TransportOf& transport, const Stress& stress);
  void finish(MomentumSlope& slope, const Part& part) const;
  std::ptrdiff_t first_face(const IndexBox& box) const;

  const GasDomain& domain_;
  Convection scheme_;
  Sides near_;                           // of one part, across x or y
  Sides below_, above_;                  // of one plane, across z
  std::vector<double> carried_, shear_;  // of one part: minus convection, and div(eps tau), N/m^3
};

}  // namespace gasgrain::cfd
