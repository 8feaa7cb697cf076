// Eight doubles at a time: one 512-bit register or two of 256 bits where the processor has them,
// else plain loops.
#pragma once
#include <cmath>
#include <cstdint>

#ifdef __AVX2__
#include <immintrin.h>
#endif
#if defined(__AVX512F__) && defined(__AVX512DQ__)
#define TRACKBED_AVX512 1
// GCC 12 takes the intrinsics' deliberately undefined operands for mistakes (its bug 105593).
#ifndef __clang__
#pragma GCC diagnostic ignored "-Wuninitialized"
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif
#endif

namespace trackbed::dem {

#ifdef TRACKBED_AVX512

struct Eight {
  __m512d v;
  Eight() = default;
  Eight(__m512d value) : v(value) {}
  Eight(double s) : v(_mm512_set1_pd(s)) {}
  static Eight load(const double* p) { return _mm512_loadu_pd(p); }
  void store(double* p) const { _mm512_storeu_pd(p, v); }
  friend Eight operator+(Eight a, Eight b) { return _mm512_add_pd(a.v, b.v); }
  friend Eight operator-(Eight a, Eight b) { return _mm512_sub_pd(a.v, b.v); }
  friend Eight operator*(Eight a, Eight b) { return _mm512_mul_pd(a.v, b.v); }
  friend Eight operator/(Eight a, Eight b) { return _mm512_div_pd(a.v, b.v); }
};
inline Eight sqrt(Eight a) { return _mm512_sqrt_pd(a.v); }
inline Eight abs(Eight a) { return _mm512_abs_pd(a.v); }
/// a[k] < b[k] ? yes[k] : no[k].
inline Eight where_less(Eight a, Eight b, Eight yes, Eight no) {
  return _mm512_mask_blend_pd(_mm512_cmp_pd_mask(a.v, b.v, _CMP_LT_OQ), no.v, yes.v);
}
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

#elif defined(__AVX2__)

struct Eight {
  __m256d low, high;
  Eight() = default;
  Eight(__m256d l, __m256d h) : low(l), high(h) {}
  Eight(double s) : low(_mm256_set1_pd(s)), high(low) {}
  static Eight load(const double* p) { return {_mm256_loadu_pd(p), _mm256_loadu_pd(p + 4)}; }
  void store(double* p) const { _mm256_storeu_pd(p, low), _mm256_storeu_pd(p + 4, high); }
  friend Eight operator+(Eight a, Eight b) { return {a.low + b.low, a.high + b.high}; }
  friend Eight operator-(Eight a, Eight b) { return {a.low - b.low, a.high - b.high}; }
  friend Eight operator*(Eight a, Eight b) { return {a.low * b.low, a.high * b.high}; }
  friend Eight operator/(Eight a, Eight b) { return {a.low / b.low, a.high / b.high}; }
};
inline Eight sqrt(Eight a) { return {_mm256_sqrt_pd(a.low), _mm256_sqrt_pd(a.high)}; }
inline Eight abs(Eight a) {
  const __m256d sign = _mm256_set1_pd(-0.);
  return {_mm256_andnot_pd(sign, a.low), _mm256_andnot_pd(sign, a.high)};
}
inline Eight where_less(Eight a, Eight b, Eight yes, Eight no) {
  return {_mm256_blendv_pd(no.low, yes.low, _mm256_cmp_pd(a.low, b.low, _CMP_LT_OQ)),
          _mm256_blendv_pd(no.high, yes.high, _mm256_cmp_pd(a.high, b.high, _CMP_LT_OQ))};
}
inline Eight fma(Eight a, Eight b, Eight c) { return a * b + c; }
inline Eight max(Eight a, Eight b) {
  return {_mm256_max_pd(a.low, b.low), _mm256_max_pd(a.high, b.high)};
}
inline Eight min(Eight a, Eight b) {
  return {_mm256_min_pd(a.low, b.low), _mm256_min_pd(a.high, b.high)};
}
inline double largest(Eight a) {
  const __m256d four = _mm256_max_pd(a.low, a.high);
  const __m128d two = _mm_max_pd(_mm256_castpd256_pd128(four), _mm256_extractf128_pd(four, 1));
  return _mm_cvtsd_f64(_mm_max_sd(two, _mm_unpackhi_pd(two, two)));
}
inline double least(Eight a) { return -largest(Eight(0.0) - a); }
inline unsigned less(Eight a, Eight b) {
  return unsigned(_mm256_movemask_pd(_mm256_cmp_pd(a.low, b.low, _CMP_LT_OQ))) |
         unsigned(_mm256_movemask_pd(_mm256_cmp_pd(a.high, b.high, _CMP_LT_OQ))) << 4;
}
inline unsigned less_equal(Eight a, Eight b) {
  return unsigned(_mm256_movemask_pd(_mm256_cmp_pd(a.low, b.low, _CMP_LE_OQ))) |
         unsigned(_mm256_movemask_pd(_mm256_cmp_pd(a.high, b.high, _CMP_LE_OQ))) << 4;
}
inline Eight divide_where(unsigned bits, Eight a, Eight b) {
  double x[8], y[8], r[8] = {};
  a.store(x), b.store(y);
  for (; bits; bits &= bits - 1) {
    const int k = __builtin_ctz(bits);
    r[k] = x[k] / y[k];
  }
  return Eight::load(r);
}

struct Places {
  std::uint64_t bytes;
  explicit Places(std::uint64_t b) : bytes(b) {}
};
inline Eight pick(Eight a, const Places& p) {
  double x[8], r[8];
  a.store(x);
  for (int k = 0; k < 8; ++k) r[k] = x[p.bytes >> (8 * k) & 7];
  return Eight::load(r);
}

#else

struct Eight {
  double v[8];
  Eight() = default;
  Eight(double s) {
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
  friend Eight operator/(Eight a, Eight b) {
    for (int k = 0; k < 8; ++k) a.v[k] /= b.v[k];
    return a;
  }
};
inline Eight sqrt(Eight a) {
  for (double& x : a.v) x = std::sqrt(x);
  return a;
}
inline Eight abs(Eight a) {
  for (double& x : a.v) x = std::abs(x);
  return a;
}
inline Eight where_less(Eight a, Eight b, Eight yes, Eight no) {
  for (int k = 0; k < 8; ++k) no.v[k] = a.v[k] < b.v[k] ? yes.v[k] : no.v[k];
  return no;
}
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

/// f(0), f(1) ... f(7). Not by way of memory where that can be helped: a register is loaded late from
/// what was stored piece by piece.
template <class F>
[[gnu::always_inline]] inline Eight eight_of(F&& f) {
#ifdef TRACKBED_AVX512
  return _mm512_setr_pd(f(0), f(1), f(2), f(3), f(4), f(5), f(6), f(7));
#elif defined(__AVX2__)
  return {_mm256_setr_pd(f(0), f(1), f(2), f(3)), _mm256_setr_pd(f(4), f(5), f(6), f(7))};
#else
  double x[8];
  for (int k = 0; k < 8; ++k) x[k] = f(k);
  return Eight::load(x);
#endif
}

// What formulas written once for one number and for eight need besides.
inline double where_less(double a, double b, double yes, double no) { return a < b ? yes : no; }
inline bool all_less(double a, double b) { return a < b; }
inline bool all_less(Eight a, Eight b) { return less(a, b) == 0xff; }
inline bool any_less(double a, double b) { return a < b; }
inline bool any_less(Eight a, Eight b) { return less(a, b) != 0; }
/// f of one number, of each of eight.
template <class F>
double each(double a, F&& f) {
  return f(a);
}
template <class F>
Eight each(Eight a, F&& f) {
  double x[8];
  a.store(x);
  for (double& v : x) v = f(v);
  return Eight::load(x);
}

}  // namespace trackbed::dem
