// A scalar on the cells or faces of one rank's block, with `halo` layers of ghosts all around.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "cfd/grid.hpp"

namespace gasgrain::cfd {

inline constexpr int halo = 2;  // ghost layers

// Local indices: owned cells 0 <= i < size; ghosts -halo <= i < 0 and size <= i < size + halo.
// A face (i,j,k) of direction d is the lower face of cell (i,j,k); the array has one more layer
// than a cell array needs, so that the upper boundary face (i = size) and two ghosts beyond it fit.
// Storage: x fastest.
class Field {
 public:
  Field() = default;
  explicit Field(const Index3& size, double value = 0.0)
      : size_(size),
        stride_{1, size[0] + 2 * halo + 1,
                std::ptrdiff_t(size[0] + 2 * halo + 1) * (size[1] + 2 * halo + 1)},
        values_(static_cast<std::size_t>(stride_[2]) * (size[2] + 2 * halo + 1), value) {}

  std::ptrdiff_t index(int i, int j, int k) const {
    return (i + halo) + (j + halo) * stride_[1] + (k + halo) * stride_[2];
  }
  double& operator()(int i, int j, int k) { return values_[index(i, j, k)]; }
  double operator()(int i, int j, int k) const { return values_[index(i, j, k)]; }
  double& operator[](std::ptrdiff_t n) { return values_[n]; }
  double operator[](std::ptrdiff_t n) const { return values_[n]; }

  const Index3& size() const { return size_; }
  std::ptrdiff_t stride(int direction) const { return stride_[direction]; }
  double* data() { return values_.data(); }
  const double* data() const { return values_.data(); }
  std::size_t count() const { return values_.size(); }
  void fill(double value) { values_.assign(values_.size(), value); }

 private:
  Index3 size_{0, 0, 0};
  std::array<std::ptrdiff_t, 3> stride_{1, 0, 0};
  std::vector<double> values_;
};

using VectorField = std::array<Field, 3>;  // component d; cell-centred or on the faces of d

}  // namespace gasgrain::cfd
