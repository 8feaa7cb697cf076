// Inside overlap(): polygons of at most eight corners in registers, cut by planes.
#pragma once
#include "dem/contact/eight.h"
#include "dem/types.h"

namespace trackbed::dem {

/// Row r of M times (x, y, z), plus t.
inline Eight row(const Mat3& M, int r, Eight x, Eight y, Eight z, Eight t) {
  return fma(Eight(M(r, 0)), x, fma(Eight(M(r, 1)), y, fma(Eight(M(r, 2)), z, t)));
}

struct Polygon {
  Eight x, y, z;
  int n;

  /// M p + t of eight corners, x of all, then y, then z (ConvexView::corners).
  void of(const Mat3& M, const Vec3& t, const double* corners) {
    const Eight cx = Eight::load(corners), cy = Eight::load(corners + 8),
                cz = Eight::load(corners + 16);
    x = row(M, 0, cx, cy, cz, Eight(t.x()));
    y = row(M, 1, cx, cy, cz, Eight(t.y()));
    z = row(M, 2, cx, cy, cz, Eight(t.z()));
  }
};

/// Where the corners of a clipped polygon come from: corner k lies between corners from[k] and
/// to[k] of the old one, which has n corners of which m, from s on, are kept.
struct ClipTable {
  std::uint64_t from[9 * 64] = {}, to[9 * 64] = {};
  constexpr ClipTable() {
    for (int n = 3; n <= 8; ++n)
      for (int s = 0; s < n; ++s)
        for (int m = 1; m < n; ++m)
          for (int k = 0; k < 8; ++k) {
            const int kept = k < m ? (s + k) % n : s;
            const std::uint64_t p = k == m ? (s + m - 1) % n : kept;
            const std::uint64_t q = k == m ? (s + m) % n : k == m + 1 ? (s + n - 1) % n : kept;
            from[n * 64 + s * 8 + m] |= p << (8 * k);
            to[n * 64 + s * 8 + m] |= q << (8 * k);
          }
  }
};
inline constexpr ClipTable kClipTable;

/// Keeps the part of the polygon at the corners of which the bits of `in` are set; d signed
/// distance to the cutting plane. False when that is not one chain or has too many corners.
[[gnu::always_inline]] inline bool clip(Polygon& p, Eight d, unsigned in) {
  const unsigned all = (1u << p.n) - 1;
  in &= all;
  if (in == all) return true;
  if (in == 0) {
    p.n = 0;
    return true;
  }
  const unsigned before = (in << 1 | in >> (p.n - 1)) & all, entering = in & ~before;
  const int s = __builtin_ctz(entering), m = __builtin_popcount(in);
  if ((entering & (entering - 1)) || m > 6) return false;
  const int entry = p.n * 64 + s * 8 + m;
  const Places from(kClipTable.from[entry]), to(kClipTable.to[entry]);
  const Eight df = pick(d, from), t = divide_where(3u << m, df, df - pick(d, to));
  const Eight x = pick(p.x, from), y = pick(p.y, from), z = pick(p.z, from);
  p.x = fma(t, pick(p.x, to) - x, x);
  p.y = fma(t, pick(p.y, to) - y, y);
  p.z = fma(t, pick(p.z, to) - z, z);
  p.n = m + 2;
  return true;
}

}  // namespace trackbed::dem
