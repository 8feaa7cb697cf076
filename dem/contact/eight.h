// Eight doubles at a time: one 512-bit register where the processor has them, else plain loops that
// the compiler turns into what there is.
#pragma once
#include <cstdint>

#if defined(__AVX512F__) && defined(__AVX512DQ__)
#define TRACKBED_AVX512 1
#include <immintrin.h>
// GCC 12 takes the intrinsics' deliberately undefined operands for mistakes (its bug 105593).
#pragma GCC diagnostic ignored "-Wuninitialized"
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif

namespace trackbed::dem {

#ifdef TRACKBED_AVX512

struct Eight {
  __m512d v;
  Eight() = default;
  Eight(__m512d value) : v(value) {}
  explicit Eight(double s) : v(_mm512_set1_pd(s)) {}
  static Eight load(const double* p) { return _mm512_loadu_pd(p); }
  void store(double* p) const { _mm512_storeu_pd(p, v); }
  friend Eight operator+(Eight a, Eight b) { return _mm512_add_pd(a.v, b.v); }
  friend Eight operator-(Eight a, Eight b) { return _mm512_sub_pd(a.v, b.v); }
  friend Eight operator*(Eight a, Eight b) { return _mm512_mul_pd(a.v, b.v); }
};
inline Eight fma(Eight a, Eight b, Eight c) { return _mm512_fmadd_pd(a.v, b.v, c.v); }
inline Eight max(Eight a, Eight b) { return _mm512_max_pd(a.v, b.v); }
inline Eight min(Eight a, Eight b) { return _mm512_min_pd(a.v, b.v); }
inline double largest(Eight a) { return _mm512_reduce_max_pd(a.v); }
inline double least(Eight a) { return _mm512_reduce_min_pd(a.v); }
/// Bit k: a[k] < b[k], a[k] <= b[k].
inline unsigned less(Eight a, Eight b) { return _mm512_cmp_pd_mask(a.v, b.v, _CMP_LT_OQ); }
inline unsigned less_equal(Eight a, Eight b) { return _mm512_cmp_pd_mask(a.v, b.v, _CMP_LE_OQ); }
/// a[k]/b[k] where bit k is set, else 0.
inline Eight divide_where(unsigned bits, Eight a, Eight b) {
  return _mm512_maskz_div_pd(static_cast<__mmask8>(bits), a.v, b.v);
}

/// Eight places 0..7, one a byte, as an index for `pick`.
struct Places {
  __m512i v;
  explicit Places(std::uint64_t bytes)
      : v(_mm512_cvtepu8_epi64(_mm_cvtsi64_si128(static_cast<long long>(bytes)))) {}
};
inline Eight pick(Eight a, const Places& p) { return _mm512_permutexvar_pd(p.v, a.v); }

#else

struct Eight {
  double v[8];
  Eight() = default;
  explicit Eight(double s) {
    for (double& x : v) x = s;
  }
  static Eight load(const double* p) {
    Eight r;
    for (int k = 0; k < 8; ++k) r.v[k] = p[k];
    return r;
  }
  void store(double* p) const {
    for (int k = 0; k < 8; ++k) p[k] = v[k];
  }
  friend Eight operator+(Eight a, Eight b) {
    for (int k = 0; k < 8; ++k) a.v[k] += b.v[k];
    return a;
  }
  friend Eight operator-(Eight a, Eight b) {
    for (int k = 0; k < 8; ++k) a.v[k] -= b.v[k];
    return a;
  }
  friend Eight operator*(Eight a, Eight b) {
    for (int k = 0; k < 8; ++k) a.v[k] *= b.v[k];
    return a;
  }
};
inline Eight fma(Eight a, Eight b, Eight c) { return a * b + c; }
inline Eight max(Eight a, Eight b) {
  for (int k = 0; k < 8; ++k) a.v[k] = a.v[k] > b.v[k] ? a.v[k] : b.v[k];
  return a;
}
inline Eight min(Eight a, Eight b) {
  for (int k = 0; k < 8; ++k) a.v[k] = a.v[k] < b.v[k] ? a.v[k] : b.v[k];
  return a;
}
inline double largest(Eight a) {
  double r = a.v[0];
  for (double x : a.v) r = x > r ? x : r;
  return r;
}
inline double least(Eight a) {
  double r = a.v[0];
  for (double x : a.v) r = x < r ? x : r;
  return r;
}
inline unsigned less(Eight a, Eight b) {
  unsigned bits = 0;
  for (int k = 0; k < 8; ++k) bits |= unsigned(a.v[k] < b.v[k]) << k;
  return bits;
}
inline unsigned less_equal(Eight a, Eight b) {
  unsigned bits = 0;
  for (int k = 0; k < 8; ++k) bits |= unsigned(a.v[k] <= b.v[k]) << k;
  return bits;
}
inline Eight divide_where(unsigned bits, Eight a, Eight b) {
  for (int k = 0; k < 8; ++k) a.v[k] = bits >> k & 1 ? a.v[k] / b.v[k] : 0;
  return a;
}

struct Places {
  std::uint64_t bytes;
  explicit Places(std::uint64_t b) : bytes(b) {}
};
inline Eight pick(Eight a, const Places& p) {
  Eight r;
  for (int k = 0; k < 8; ++k) r.v[k] = a.v[p.bytes >> (8 * k) & 7];
  return r;
}

#endif

}  // namespace trackbed::dem
