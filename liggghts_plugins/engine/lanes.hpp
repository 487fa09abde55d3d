// Eight doubles at a time, in the vector extensions of GCC and Clang: the same source serves every
// instruction set. Everything has internal linkage, because files that include this are compiled
// for different processors.
#pragma once

#if defined(__AVX512F__) && defined(__AVX512DQ__) && defined(__AVX512VL__)
#include <immintrin.h>
#endif

namespace gasgrain::plugins {
namespace {

using Lanes = double __attribute__((vector_size(64)));
using Quad = double __attribute__((vector_size(32)));
using LaneMask = long long __attribute__((vector_size(64)));  // -1: true, 0: false

#define GASGRAIN_LANES_INLINE inline __attribute__((always_inline))

GASGRAIN_LANES_INLINE Lanes all_lanes(double value) {
  return Lanes{value, value, value, value, value, value, value, value};
}

GASGRAIN_LANES_INLINE Quad load_quad(const double* aligned) {
  return *reinterpret_cast<const Quad*>(aligned);
}

GASGRAIN_LANES_INLINE void store_quad(double* aligned, Quad value) {
  *reinterpret_cast<Quad*>(aligned) = value;
}

GASGRAIN_LANES_INLINE Lanes join(Quad low, Quad high) {
  return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
}
GASGRAIN_LANES_INLINE Quad low_half(Lanes a) {
  return __builtin_shufflevector(a, a, 0, 1, 2, 3);
}
GASGRAIN_LANES_INLINE Quad high_half(Lanes a) {
  return __builtin_shufflevector(a, a, 4, 5, 6, 7);
}

struct FourLanes {
  Lanes a, b, c, d;
};

// 4 x 4 transposition in each half: rows (r0 r4) (r1 r5) (r2 r6) (r3 r7) <-> columns a b c d.
GASGRAIN_LANES_INLINE FourLanes transposed(const FourLanes& rows) {
  const Lanes t0 = __builtin_shufflevector(rows.a, rows.b, 0, 8, 2, 10, 4, 12, 6, 14);
  const Lanes t1 = __builtin_shufflevector(rows.a, rows.b, 1, 9, 3, 11, 5, 13, 7, 15);
  const Lanes t2 = __builtin_shufflevector(rows.c, rows.d, 0, 8, 2, 10, 4, 12, 6, 14);
  const Lanes t3 = __builtin_shufflevector(rows.c, rows.d, 1, 9, 3, 11, 5, 13, 7, 15);
  return {__builtin_shufflevector(t0, t2, 0, 1, 8, 9, 4, 5, 12, 13),
          __builtin_shufflevector(t1, t3, 0, 1, 8, 9, 4, 5, 12, 13),
          __builtin_shufflevector(t0, t2, 2, 3, 10, 11, 6, 7, 14, 15),
          __builtin_shufflevector(t1, t3, 2, 3, 10, 11, 6, 7, 14, 15)};
}

// Four values of each of eight records, as columns.
GASGRAIN_LANES_INLINE FourLanes columns(const double* r0, const double* r1, const double* r2,
                                        const double* r3, const double* r4, const double* r5,
                                        const double* r6, const double* r7) {
  return transposed({join(load_quad(r0), load_quad(r4)), join(load_quad(r1), load_quad(r5)),
                     join(load_quad(r2), load_quad(r6)), join(load_quad(r3), load_quad(r7))});
}

// Square root; the argument is positive.
GASGRAIN_LANES_INLINE Lanes root(Lanes a) {
#if defined(__AVX512F__)
  return reinterpret_cast<Lanes>(_mm512_sqrt_pd(reinterpret_cast<__m512d>(a)));
#else
  Lanes result;
  for (int lane = 0; lane < 8; ++lane) result[lane] = __builtin_sqrt(a[lane]);
  return result;
#endif
}

// One bit per lane, lowest first.
GASGRAIN_LANES_INLINE unsigned bits(LaneMask mask) {
#if defined(__AVX512DQ__)
  return _mm512_movepi64_mask(reinterpret_cast<__m512i>(mask));
#else
  unsigned result = 0;
  for (int lane = 0; lane < 8; ++lane) result |= mask[lane] ? 1u << lane : 0u;
  return result;
#endif
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
