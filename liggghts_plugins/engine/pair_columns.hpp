// Records of eight pairs as columns for the vector code: what the kernel reads of grains, spins and
// springs. Differences and sums of the two grains of a pair are taken in double before the records
// are transposed: half the shuffles, and single precision loses nothing of small differences.
#pragma once

#include "liggghts_plugins/engine/kernel.hpp"
#include "liggghts_plugins/engine/lanes.hpp"

namespace gasgrain::plugins {
namespace {

template <class Real>
struct Vector {
  Lanes<Real> x, y, z;

  friend GASGRAIN_LANES_INLINE Vector operator-(const Vector& a, const Vector& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
  }
  friend GASGRAIN_LANES_INLINE Vector operator+(const Vector& a, const Vector& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
  }
  friend GASGRAIN_LANES_INLINE Vector operator*(Lanes<Real> s, const Vector& a) {
    return {s * a.x, s * a.y, s * a.z};
  }
  friend GASGRAIN_LANES_INLINE Lanes<Real> dot(const Vector& a, const Vector& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
  }
  friend GASGRAIN_LANES_INLINE Vector cross(const Vector& a, const Vector& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
  }
};

template <class Real>
GASGRAIN_LANES_INLINE Vector<Real> vector_of(const FourLanes<Real>& c) {
  return {c.a, c.b, c.c};
}

// Offsets of the quads within GrainRecord.
constexpr int position_quad = 0, velocity_quad = 4;

// Four values of each of eight records, from `offset` on.
template <class Real, class Record>
GASGRAIN_LANES_INLINE FourLanes<Real> rows(const Record* base, const int* index, int offset) {
  const auto at = [&](int lane) {
    return load_quad(reinterpret_cast<const Real*>(base + index[lane]) + offset);
  };
  return {join(at(0), at(4)), join(at(1), at(5)), join(at(2), at(6)), join(at(3), at(7))};
}

template <class Real>
GASGRAIN_LANES_INLINE Vector<Real> springs_of(const SpringRecord<Real>* springs,
                                              const int* places) {
  const auto at = [&](int lane) { return load_three(springs[places[lane]].displacement); };
  return vector_of(transposed<Real>(
      {join(at(0), at(4)), join(at(1), at(5)), join(at(2), at(6)), join(at(3), at(7))}));
}

GASGRAIN_LANES_INLINE FourLanes<double> operator-(const FourLanes<double>& i,
                                                  const FourLanes<double>& j) {
  return {i.a - j.a, i.b - j.b, i.c - j.c, i.d - j.d};
}
GASGRAIN_LANES_INLINE FourLanes<double> operator+(const FourLanes<double>& i,
                                                  const FourLanes<double>& j) {
  return {i.a + j.a, i.b + j.b, i.c + j.c, i.d + j.d};
}

template <class Real>
GASGRAIN_LANES_INLINE FourLanes<Real> columns(const FourLanes<double>& rows) {
  return transposed<Real>(
      {rounded<Real>(rows.a), rounded<Real>(rows.b), rounded<Real>(rows.c), rounded<Real>(rows.d)});
}

// Vector between the centres and sum of the radii.
GASGRAIN_LANES_INLINE FourLanes<double> separation(const GrainRecord* grains, const int* first,
                                                   const int* second) {
  const FourLanes<double> i = rows<double>(grains, first, position_quad);
  const FourLanes<double> j = rows<double>(grains, second, position_quad);
  const Lanes<double> sign = {1, 1, 1, -1, 1, 1, 1, -1};
  return transposed<double>(
      {i.a - sign * j.a, i.b - sign * j.b, i.c - sign * j.c, i.d - sign * j.d});
}

template <class Real>
GASGRAIN_LANES_INLINE Lanes<Real> radii_of(const GrainRecord* grains, const int* index) {
  const auto at = [&](int lane) { return grains[index[lane]].radius; };
  return rounded<Real>(Lanes<double>{at(0), at(1), at(2), at(3), at(4), at(5), at(6), at(7)});
}

// The row that holds the pair `lane`, in its lower half for the first four.
template <class Real>
GASGRAIN_LANES_INLINE Lanes<Real> row_pair(const FourLanes<Real>& rows, int lane) {
  return lane % 4 == 0 ? rows.a : lane % 4 == 1 ? rows.b : lane % 4 == 2 ? rows.c : rows.d;
}

}  // namespace
}  // namespace gasgrain::plugins
