// The samples that a value interpolated between them is made of, and their weighted sums.
//
// Rows along x are padded to four numbers, so that sums over z and y work on whole rows.
#pragma once

#include <array>

#include "coupling/shared/vec3.hpp"

namespace gasgrain {

// Weights of `count` samples in a row, padded with zeros.
struct RowWeights {
  Eigen::Array4d weight = Eigen::Array4d::Zero();  // -
  Eigen::Array4d slope = Eigen::Array4d::Zero();   // their derivatives, 1/spacing
  Eigen::Array4d bend = Eigen::Array4d::Zero();    // second derivatives, 1/spacing^2
};

// At `f`: place within the cell (linear, 2 samples, 0..1) or from the middle sample (quadratic
// B-spline, 3 samples, -1/2..1/2).
template <int count>
RowWeights row_weights(double f) {
  RowWeights result;
  if constexpr (count == 2) {
    result.weight << 1 - f, f, 0, 0;
    result.slope << -1, 1, 0, 0;
  } else {
    result.weight << 0.5 * (0.5 - f) * (0.5 - f), 0.75 - f * f, 0.5 * (0.5 + f) * (0.5 + f), 0;
    result.slope << f - 0.5, -2 * f, f + 0.5, 0;
    result.bend << 1, -2, 1, 0;
  }
  return result;
}

// Value and derivatives; lengths in spacings.
struct StencilSum {
  double value;
  Vec3 gradient;
};

template <int count>
struct SampleStencil {
  std::array<RowWeights, 3> along;                            // x, y, z
  std::array<std::array<Eigen::Array4d, count>, count> rows;  // [z][y], along x

  StencilSum sum() const {
    Eigen::Array4d value = Eigen::Array4d::Zero(), by_y = value, by_z = value;
    for (int j = 0; j < count; ++j) {
      const Eigen::Array4d row = across_z(j, along[2].weight);
      value += along[1].weight[j] * row;
      by_y += along[1].slope[j] * row;
      by_z += along[1].weight[j] * across_z(j, along[2].slope);
    }
    const auto x = [&](const Eigen::Array4d& weights, const Eigen::Array4d& row) {
      return (weights * row).sum();
    };
    return {x(along[0].weight, value),
            Vec3(x(along[0].slope, value), x(along[0].weight, by_y), x(along[0].weight, by_z))};
  }

  // Second derivatives, 1/spacing.
  Mat3 curvature() const {
    const Eigen::Array4d zero = Eigen::Array4d::Zero();
    Eigen::Array4d value = zero, by_y = zero, by_z = zero, by_yy = zero, by_yz = zero, by_zz = zero;
    for (int j = 0; j < count; ++j) {
      const Eigen::Array4d row = across_z(j, along[2].weight), slope = across_z(j, along[2].slope);
      value += along[1].weight[j] * row;
      by_y += along[1].slope[j] * row;
      by_yy += along[1].bend[j] * row;
      by_z += along[1].weight[j] * slope;
      by_yz += along[1].slope[j] * slope;
      by_zz += along[1].weight[j] * across_z(j, along[2].bend);
    }
    const auto x = [&](const Eigen::Array4d& weights, const Eigen::Array4d& row) {
      return (weights * row).sum();
    };
    const double xx = x(along[0].bend, value), xy = x(along[0].slope, by_y),
                 xz = x(along[0].slope, by_z), yy = x(along[0].weight, by_yy),
                 yz = x(along[0].weight, by_yz), zz = x(along[0].weight, by_zz);
    Mat3 result;
    result << xx, xy, xz, xy, yy, yz, xz, yz, zz;
    return result;
  }

 private:
  Eigen::Array4d across_z(int j, const Eigen::Array4d& weights) const {
    Eigen::Array4d result = weights[0] * rows[0][j];
    for (int k = 1; k < count; ++k) result += weights[k] * rows[k][j];
    return result;
  }
};

}  // namespace gasgrain
