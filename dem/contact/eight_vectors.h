// Eight vectors at a time, components apart, and how they get to and from arrays of Vec3; the few
// operations by which formulas are written once for one contact (Vec3) and for eight (Eight3).
#pragma once
#include <cstring>
#include <utility>

#include "dem/contact/eight.h"
#include "dem/types.h"

namespace trackbed::dem {

struct Eight3 {
  Eight x, y, z;
  Eight3() = default;
  Eight3(Eight a, Eight b, Eight c) : x(a), y(b), z(c) {}
  explicit Eight3(const Vec3& v) : x(v.x()), y(v.y()), z(v.z()) {}
  friend Eight3 operator+(const Eight3& a, const Eight3& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
  }
  friend Eight3 operator-(const Eight3& a, const Eight3& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
  }
  friend Eight3 operator*(Eight s, const Eight3& a) { return {s * a.x, s * a.y, s * a.z}; }
};

[[gnu::always_inline]] inline Eight dot(const Eight3& a, const Eight3& b) {
  return fma(a.x, b.x, fma(a.y, b.y, a.z * b.z));
}
[[gnu::always_inline]] inline Eight3 cross(const Eight3& a, const Eight3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline Eight3 where_less(Eight a, Eight b, const Eight3& yes, const Eight3& no) {
  return {where_less(a, b, yes.x, no.x), where_less(a, b, yes.y, no.y),
          where_less(a, b, yes.z, no.z)};
}
inline double dot(const Vec3& a, const Vec3& b) { return a.dot(b); }
inline Vec3 cross(const Vec3& a, const Vec3& b) { return a.cross(b); }
template <class V>
auto squared_norm(const V& a) {
  return dot(a, a);
}

/// Its number: double of Vec3, Eight of Eight3.
template <class V>
using NumberOf = decltype(squared_norm(std::declval<V>()));

#ifdef TRACKBED_AVX512

/// Eight in a row.
[[gnu::always_inline]] inline Eight3 load3(const Vec3* v) {
  const double* p = v->data();
  const __m512d a = _mm512_loadu_pd(p), b = _mm512_loadu_pd(p + 8), c = _mm512_loadu_pd(p + 16);
  const auto pick = [&](__m512i ab, __m512i with_c) {
    return _mm512_permutex2var_pd(_mm512_permutex2var_pd(a, ab, b), with_c, c);
  };
  return {pick(_mm512_setr_epi64(0, 3, 6, 9, 12, 15, 0, 0),
               _mm512_setr_epi64(0, 1, 2, 3, 4, 5, 10, 13)),
          pick(_mm512_setr_epi64(1, 4, 7, 10, 13, 0, 0, 0),
               _mm512_setr_epi64(0, 1, 2, 3, 4, 8, 11, 14)),
          pick(_mm512_setr_epi64(2, 5, 8, 11, 14, 0, 0, 0),
               _mm512_setr_epi64(0, 1, 2, 3, 4, 9, 12, 15))};
}
[[gnu::always_inline]] inline void store3(Vec3* v, const Eight3& r) {
  double* p = v->data();
  const auto pick = [&](__m512i xy, __m512i with_z) {
    return _mm512_permutex2var_pd(_mm512_permutex2var_pd(r.x.v, xy, r.y.v), with_z, r.z.v);
  };
  _mm512_storeu_pd(p, pick(_mm512_setr_epi64(0, 8, 0, 1, 9, 0, 2, 10),
                           _mm512_setr_epi64(0, 1, 8, 3, 4, 9, 6, 7)));
  _mm512_storeu_pd(p + 8, pick(_mm512_setr_epi64(0, 3, 11, 0, 4, 12, 0, 5),
                               _mm512_setr_epi64(10, 1, 2, 11, 4, 5, 12, 7)));
  _mm512_storeu_pd(p + 16, pick(_mm512_setr_epi64(13, 0, 6, 14, 0, 7, 15, 0),
                                _mm512_setr_epi64(0, 13, 2, 3, 14, 5, 6, 15)));
}
/// Those at eight places.
[[gnu::always_inline]] inline Eight3 gather3(const Vec3* v, const int* at) {
  const auto row = [&](int k) {
    return _mm512_insertf64x4(_mm512_castpd256_pd512(_mm256_maskz_loadu_pd(7, v[at[k]].data())),
                              _mm256_maskz_loadu_pd(7, v[at[k + 4]].data()), 1);
  };
  const __m512d a = row(0), b = row(1), c = row(2), d = row(3);
  const __m512d xz = _mm512_unpacklo_pd(a, b), xz2 = _mm512_unpacklo_pd(c, d);
  const __m512i first = _mm512_setr_epi64(0, 1, 8, 9, 4, 5, 12, 13),
                second = _mm512_setr_epi64(2, 3, 10, 11, 6, 7, 14, 15);
  return {_mm512_permutex2var_pd(xz, first, xz2),
          _mm512_permutex2var_pd(_mm512_unpackhi_pd(a, b), first, _mm512_unpackhi_pd(c, d)),
          _mm512_permutex2var_pd(xz, second, xz2)};
}
/// To eight places.
[[gnu::always_inline]] inline void scatter(double* v, const int* at, Eight r) {
  const auto two = [&](__m128d p, int k) {
    _mm_storel_pd(v + at[k], p), _mm_storeh_pd(v + at[k + 1], p);
  };
  two(_mm512_castpd512_pd128(r.v), 0), two(_mm512_extractf64x2_pd(r.v, 1), 2);
  two(_mm512_extractf64x2_pd(r.v, 2), 4), two(_mm512_extractf64x2_pd(r.v, 3), 6);
}
[[gnu::always_inline]] inline void scatter3(Vec3* v, const int* at, const Eight3& r) {
  const __m512d even = _mm512_unpacklo_pd(r.x.v, r.y.v), odd = _mm512_unpackhi_pd(r.x.v, r.y.v);
  const auto two = [&](__m128d xy, __m128d xy_next, __m128d z, int k) {
    double *p = v[at[k]].data(), *q = v[at[k + 1]].data();
    _mm_storeu_pd(p, xy), _mm_storel_pd(p + 2, z);
    _mm_storeu_pd(q, xy_next), _mm_storeh_pd(q + 2, z);
  };
  two(_mm512_castpd512_pd128(even), _mm512_castpd512_pd128(odd), _mm512_castpd512_pd128(r.z.v), 0);
  two(_mm512_extractf64x2_pd(even, 1), _mm512_extractf64x2_pd(odd, 1),
      _mm512_extractf64x2_pd(r.z.v, 1), 2);
  two(_mm512_extractf64x2_pd(even, 2), _mm512_extractf64x2_pd(odd, 2),
      _mm512_extractf64x2_pd(r.z.v, 2), 4);
  two(_mm512_extractf64x2_pd(even, 3), _mm512_extractf64x2_pd(odd, 3),
      _mm512_extractf64x2_pd(r.z.v, 3), 6);
}

#else

[[gnu::always_inline]] inline void scatter(double* v, const int* at, Eight r) {
  double x[8];
  r.store(x);
  for (int k = 0; k < 8; ++k) v[at[k]] = x[k];
}
[[gnu::always_inline]] inline void scatter3(Vec3* v, const int* at, const Eight3& r) {
  double x[8], y[8], z[8];
  r.x.store(x), r.y.store(y), r.z.store(z);
  for (int k = 0; k < 8; ++k) v[at[k]] = Vec3(x[k], y[k], z[k]);
}
[[gnu::always_inline]] inline Eight3 gather3(const Vec3* v, const int* at) {
  double x[8], y[8], z[8];
  for (int k = 0; k < 8; ++k) x[k] = v[at[k]].x(), y[k] = v[at[k]].y(), z[k] = v[at[k]].z();
  return {Eight::load(x), Eight::load(y), Eight::load(z)};
}
[[gnu::always_inline]] inline Eight3 load3(const Vec3* v) {
  constexpr int kRow[8] = {0, 1, 2, 3, 4, 5, 6, 7};
  return gather3(v, kRow);
}
[[gnu::always_inline]] inline void store3(Vec3* v, const Eight3& r) {
  constexpr int kRow[8] = {0, 1, 2, 3, 4, 5, 6, 7};
  scatter3(v, kRow, r);
}

#endif

/// Sum of the first `count`, always in the same order.
inline double sum_first(Eight a, int count) {
  double x[8];
  a.store(x);
  for (int k = count; k < 8; ++k) x[k] = 0;
  return ((x[0] + x[1]) + (x[2] + x[3])) + ((x[4] + x[5]) + (x[6] + x[7]));
}

/// Up to eight places of an array, in a row or not; those from `count` on repeat the first one and
/// are read but not written.
struct Eightfold {
  int at[8];
  int count = 0;
  bool in_a_row = false;
  void add(int place) { at[count++] = place; }
  /// `n` places from `first` on, up to eight.
  static Eightfold row(int first, int n) {
    Eightfold e;
    for (int k = 0; k < 8; ++k) e.at[k] = first + (k < n ? k : 0);
    e.count = n;
    e.in_a_row = n == 8;
    return e;
  }
  /// Places that are stored at other places.
  void of(const int* places, const Eightfold& e) {
    count = e.count;
    if (e.in_a_row)
      std::memcpy(at, places + e.at[0], sizeof at);
    else
      for (int k = 0; k < 8; ++k) at[k] = places[e.at[k]];
  }
  void complete() {
    in_a_row = count == 8 && at[7] - at[0] == 7;  // ascending
    for (int k = count; k < 8; ++k) at[k] = at[0];
  }
};

/// Whether eight bytes from `p` on are all `value`.
inline bool all_are(const std::uint8_t* p, std::uint8_t value) {
  std::uint64_t eight;
  std::memcpy(&eight, p, sizeof eight);
  return eight == 0x0101010101010101u * value;
}

[[gnu::always_inline]] inline Eight3 read(const Vec3* v, const Eightfold& e) {
  return e.in_a_row ? load3(v + e.at[0]) : gather3(v, e.at);
}
template <class T>
[[gnu::always_inline]] inline Eight read(const T* v, const Eightfold& e) {
  return eight_of([&](int k) { return double(v[e.at[k]]); });
}
[[gnu::always_inline]] inline Eight read(const double* v, const Eightfold& e) {
  return e.in_a_row ? Eight::load(v + e.at[0]) : read<double>(v, e);
}
[[gnu::always_inline]] inline void write(Vec3* v, const Eightfold& e, const Eight3& r) {
  if (e.in_a_row) return store3(v + e.at[0], r);
  if (e.count == 8) return scatter3(v, e.at, r);
  double x[8], y[8], z[8];
  r.x.store(x), r.y.store(y), r.z.store(z);
  for (int k = 0; k < e.count; ++k) v[e.at[k]] = Vec3(x[k], y[k], z[k]);
}
[[gnu::always_inline]] inline void write(double* v, const Eightfold& e, Eight r) {
  if (e.in_a_row) return r.store(v + e.at[0]);
  if (e.count == 8) return scatter(v, e.at, r);
  double x[8];
  r.store(x);
  for (int k = 0; k < e.count; ++k) v[e.at[k]] = x[k];
}

/// a[0] b[0] a[1] b[1] ...: 16 numbers.
[[gnu::always_inline]] inline void store_pairs(double* p, Eight a, Eight b) {
#ifdef TRACKBED_AVX512
  const __m512i low = _mm512_setr_epi64(0, 8, 1, 9, 2, 10, 3, 11),
                high = _mm512_setr_epi64(4, 12, 5, 13, 6, 14, 7, 15);
  _mm512_storeu_pd(p, _mm512_permutex2var_pd(a.v, low, b.v));
  _mm512_storeu_pd(p + 8, _mm512_permutex2var_pd(a.v, high, b.v));
#else
  double x[8], y[8];
  a.store(x), b.store(y);
  for (int k = 0; k < 8; ++k) p[2 * k] = x[k], p[2 * k + 1] = y[k];
#endif
}

/// Vectors of four numbers.
[[gnu::always_inline]] inline void read4(const Eigen::Vector4d* v, const Eightfold& e,
                                         Eight (&r)[4]) {
#ifdef TRACKBED_AVX512
  const auto two = [&](int k) {
    return _mm512_insertf64x4(_mm512_castpd256_pd512(_mm256_loadu_pd(v[e.at[k]].data())),
                              _mm256_loadu_pd(v[e.at[k + 1]].data()), 1);
  };
  const __m512d a = two(0), b = two(2), c = two(4), d = two(6);
  const __m512i first = _mm512_setr_epi64(0, 4, 8, 12, 1, 5, 9, 13),
                second = _mm512_setr_epi64(2, 6, 10, 14, 3, 7, 11, 15);
  const __m512d xy = _mm512_permutex2var_pd(a, first, b), zw = _mm512_permutex2var_pd(a, second, b),
                xy2 = _mm512_permutex2var_pd(c, first, d),
                zw2 = _mm512_permutex2var_pd(c, second, d);
  r[0] = _mm512_shuffle_f64x2(xy, xy2, 0x44), r[1] = _mm512_shuffle_f64x2(xy, xy2, 0xee);
  r[2] = _mm512_shuffle_f64x2(zw, zw2, 0x44), r[3] = _mm512_shuffle_f64x2(zw, zw2, 0xee);
#else
  double x[4][8];
  for (int k = 0; k < 8; ++k)
    for (int d = 0; d < 4; ++d) x[d][k] = v[e.at[k]][d];
  for (int d = 0; d < 4; ++d) r[d] = Eight::load(x[d]);
#endif
}
[[gnu::always_inline]] inline void write4(Eigen::Vector4d* v, const Eightfold& e,
                                          const Eight (&r)[4]) {
  double xy[16], zw[16];
  store_pairs(xy, r[0], r[1]), store_pairs(zw, r[2], r[3]);
  for (int k = 0; k < e.count; ++k)
    v[e.at[k]] = Eigen::Vector4d(xy[2 * k], xy[2 * k + 1], zw[2 * k], zw[2 * k + 1]);
}

}  // namespace trackbed::dem
