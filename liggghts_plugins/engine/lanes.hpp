// Eight doubles or floats at a time, in the vector extensions of GCC and Clang: the same source
// serves every instruction set. Everything has internal linkage, because files that include this
// are compiled for different processors.
#pragma once

#if defined(__AVX512F__) && defined(__AVX512DQ__) && defined(__AVX512VL__)
#include <immintrin.h>
#endif

namespace gasgrain::plugins {
namespace {

#define GASGRAIN_LANES_INLINE inline __attribute__((always_inline))

template <class Real>
struct Vectors;
template <>
struct Vectors<double> {
  using Eight = double __attribute__((vector_size(64)));
  using Four = double __attribute__((vector_size(32)));
  using Mask = long long __attribute__((vector_size(64)));  // -1: true, 0: false
};
template <>
struct Vectors<float> {
  using Eight = float __attribute__((vector_size(32)));
  using Four = float __attribute__((vector_size(16)));
  using Mask = int __attribute__((vector_size(32)));
};

template <class Real>
using Lanes = typename Vectors<Real>::Eight;
template <class Real>
using Quad = typename Vectors<Real>::Four;
template <class Real>
using LaneMask = typename Vectors<Real>::Mask;

// Eight equal values.
template <class Real>
GASGRAIN_LANES_INLINE Lanes<Real> all_lanes(double value) {
  const Real v = static_cast<Real>(value);
  return Lanes<Real>{v, v, v, v, v, v, v, v};
}

template <class Real>
GASGRAIN_LANES_INLINE Quad<Real> load_quad(const Real* aligned) {
  return *reinterpret_cast<const Quad<Real>*>(aligned);
}

template <class Real>
GASGRAIN_LANES_INLINE void store_quad(Real* aligned, Quad<Real> value) {
  *reinterpret_cast<Quad<Real>*>(aligned) = value;
}

// Three values from anywhere; a fourth behind them is read, too.
template <class Real>
GASGRAIN_LANES_INLINE Quad<Real> load_three(const Real* values) {
  Quad<Real> result;
  __builtin_memcpy(&result, values, sizeof result);
  return result;
}

// Eight values from anywhere.
template <class Real>
GASGRAIN_LANES_INLINE Lanes<Real> load_lanes(const Real* values) {
  Lanes<Real> result;
  __builtin_memcpy(&result, values, sizeof result);
  return result;
}

template <class Real>
GASGRAIN_LANES_INLINE void store_three(Real* values, Quad<Real> three) {
  __builtin_memcpy(values, &three, 3 * sizeof(Real));
}

// In single precision or as they are.
template <class Real>
GASGRAIN_LANES_INLINE Lanes<Real> rounded(Lanes<double> a) {
  return __builtin_convertvector(a, Lanes<Real>);
}

template <class Four>
GASGRAIN_LANES_INLINE auto join(Four low, Four high) {
  return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
}
template <class Eight>
GASGRAIN_LANES_INLINE auto low_half(Eight a) {
  return __builtin_shufflevector(a, a, 0, 1, 2, 3);
}
template <class Eight>
GASGRAIN_LANES_INLINE auto high_half(Eight a) {
  return __builtin_shufflevector(a, a, 4, 5, 6, 7);
}

template <class Real>
struct FourLanes {
  Lanes<Real> a, b, c, d;
};

// 4 x 4 transposition in each half: rows (r0 r4) (r1 r5) (r2 r6) (r3 r7) <-> columns a b c d.
template <class Real>
GASGRAIN_LANES_INLINE FourLanes<Real> transposed(const FourLanes<Real>& rows) {
  const Lanes<Real> t0 = __builtin_shufflevector(rows.a, rows.b, 0, 8, 2, 10, 4, 12, 6, 14);
  const Lanes<Real> t1 = __builtin_shufflevector(rows.a, rows.b, 1, 9, 3, 11, 5, 13, 7, 15);
  const Lanes<Real> t2 = __builtin_shufflevector(rows.c, rows.d, 0, 8, 2, 10, 4, 12, 6, 14);
  const Lanes<Real> t3 = __builtin_shufflevector(rows.c, rows.d, 1, 9, 3, 11, 5, 13, 7, 15);
  return {__builtin_shufflevector(t0, t2, 0, 1, 8, 9, 4, 5, 12, 13),
          __builtin_shufflevector(t1, t3, 0, 1, 8, 9, 4, 5, 12, 13),
          __builtin_shufflevector(t0, t2, 2, 3, 10, 11, 6, 7, 14, 15),
          __builtin_shufflevector(t1, t3, 2, 3, 10, 11, 6, 7, 14, 15)};
}

// Square root; the argument is positive.
GASGRAIN_LANES_INLINE Lanes<double> root(Lanes<double> a) {
#if defined(__AVX512F__)
  return reinterpret_cast<Lanes<double>>(_mm512_maskz_sqrt_pd(0xff, reinterpret_cast<__m512d>(a)));
#else
  Lanes<double> result;
  for (int lane = 0; lane < 8; ++lane) result[lane] = __builtin_sqrt(a[lane]);
  return result;
#endif
}
GASGRAIN_LANES_INLINE Lanes<float> root(Lanes<float> a) {
#if defined(__AVX512VL__)
  return reinterpret_cast<Lanes<float>>(_mm256_sqrt_ps(reinterpret_cast<__m256>(a)));
#else
  Lanes<float> result;
  for (int lane = 0; lane < 8; ++lane) result[lane] = __builtin_sqrtf(a[lane]);
  return result;
#endif
}

// One bit per lane, lowest first.
GASGRAIN_LANES_INLINE unsigned bits(LaneMask<double> mask) {
#if defined(__AVX512DQ__)
  return _mm512_movepi64_mask(reinterpret_cast<__m512i>(mask));
#else
  unsigned result = 0;
  for (int lane = 0; lane < 8; ++lane) result |= mask[lane] ? 1u << lane : 0u;
  return result;
#endif
}
GASGRAIN_LANES_INLINE unsigned bits(LaneMask<float> mask) {
#if defined(__AVX512VL__)
  return _mm256_movepi32_mask(reinterpret_cast<__m256i>(mask));
#else
  unsigned result = 0;
  for (int lane = 0; lane < 8; ++lane) result |= mask[lane] ? 1u << lane : 0u;
  return result;
#endif
}
GASGRAIN_LANES_INLINE bool any(LaneMask<double> mask) {
  return bits(mask) != 0;
}
GASGRAIN_LANES_INLINE bool any(LaneMask<float> mask) {
  return bits(mask) != 0;
}

// Writes begin + lane for every lane that is set, densely; eight values may be written. Returns the
// number of lanes set.
GASGRAIN_LANES_INLINE int write_places(int* places, int begin, unsigned set) {
#if defined(__AVX512VL__)
  const __m256i all =
      _mm256_add_epi32(_mm256_set1_epi32(begin), _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7));
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(places),
                      _mm256_maskz_compress_epi32(static_cast<__mmask8>(set), all));
  return __builtin_popcount(set);
#else
  int count = 0;
  for (int lane = 0; lane < 8; ++lane) {
    places[count] = begin + lane;
    count += (set >> lane) & 1u;
  }
  return count;
#endif
}

}  // namespace
}  // namespace gasgrain::plugins
