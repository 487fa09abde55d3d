// What the gas does to one body.
#pragma once

#include "coupling/shared/vec3.hpp"

namespace gasgrain::cfd {

// Means over the last step of what gas (and, by pressure, the grains' share of it) does to a body.
// The torques are about Body::torque_point where it is at the end of the step.
struct BodyLoad {
  Vec3 pressure = Vec3::Zero();         // N
  Vec3 friction = Vec3::Zero();         // N
  Vec3 pressure_torque = Vec3::Zero();  // N m
  Vec3 friction_torque = Vec3::Zero();  // N m
};

}  // namespace gasgrain::cfd
