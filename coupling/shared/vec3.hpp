// The three-vector of the whole project. The only file that names Eigen for it.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>  // Vec3::cross
#include <Eigen/Geometry>

namespace gasgrain {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;

}  // namespace gasgrain
