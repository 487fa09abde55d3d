// The bracket of step 1 of the scheme (gas_solver.cpp): convection and viscous stress on faces.
#pragma once

#include "cfd/face_medium.hpp"
#include "cfd/gas_domain.hpp"

namespace gasgrain::cfd {

// At one time, with its integrals over the control volumes of this rank.
struct MomentumSlope {
  VectorField total;               // N/m^3 on faces; without the stress when that is kept apart
  VectorField stress;              // N/m^3 on faces; empty unless it is kept apart
  Vec3 convection = Vec3::Zero();  // N
  Vec3 viscous = Vec3::Zero();     // N
};

// `velocity` with ghosts filled. The fields of `slope` have the size of the block; a field for the
// stress keeps it apart.
void evaluate(MomentumSlope& slope, const GasDomain& domain, const FaceMedium& medium,
              const VectorField& velocity, Convection scheme);

}  // namespace gasgrain::cfd
