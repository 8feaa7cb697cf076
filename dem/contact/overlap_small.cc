// Clipping of bodies of ordinary size, polygons in registers; see overlap.h for the method.
#include "dem/contact/overlap_simple.h"
#include "dem/contact/polygon_clip.h"

namespace trackbed::dem {
namespace {

constexpr std::uint64_t first_bits(int n) { return n >= 64 ? ~0ull : (1ull << n) - 1; }

bool suitable(const ConvexView& v) {
  return v.padded <= kMost && v.padded % 8 == 0 && v.padded >= v.vertices && v.faces <= kMost;
}

void vertices_to_frame(const PlacedBody& body, Side& s) {
  const ConvexView& v = body.view;
  const Eight tx(body.t.x()), ty(body.t.y()), tz(body.t.z());
  Eight high(-1e300), low(1e300);
  for (int k = 0; k < v.padded; k += 8) {
    const Eight x = Eight::load(v.x + k), y = Eight::load(v.y + k), z = Eight::load(v.z + k);
    const Eight w = row(body.M, 2, x, y, z, tz);
    row(body.M, 0, x, y, z, tx).store(s.x + k);
    row(body.M, 1, x, y, z, ty).store(s.y + k);
    w.store(s.z + k);
    high = max(high, w), low = min(low, w);
  }
  s.high = largest(high), s.low = least(low);
}

void planes_to_frame(const PlacedBody& body, Side& s) {
  const ConvexView& v = body.view;
  const Mat3& M = body.M;
  if (!v.planes_padded) {
    for (int f = 0; f < v.faces; ++f) {
      const Vec3 n = M * Vec3(v.nx[f], v.ny[f], v.nz[f]);
      s.nx[f] = n.x(), s.ny[f] = n.y(), s.nz[f] = n.z(), s.offset[f] = v.offset[f] + n.dot(body.t);
    }
    for (int f = v.faces; f % 8 != 0; ++f) s.nx[f] = s.ny[f] = s.nz[f] = s.offset[f] = 0;
    return;
  }
  const Eight zero(0.0), tx(body.t.x()), ty(body.t.y()), tz(body.t.z());
  for (int f = 0; f < v.faces; f += 8) {
    const Eight x = Eight::load(v.nx + f), y = Eight::load(v.ny + f), z = Eight::load(v.nz + f);
    const Eight nx = row(M, 0, x, y, z, zero), ny = row(M, 1, x, y, z, zero),
                nz = row(M, 2, x, y, z, zero);
    nx.store(s.nx + f), ny.store(s.ny + f), nz.store(s.nz + f);
    fma(nx, tx, fma(ny, ty, fma(nz, tz, Eight::load(v.offset + f)))).store(s.offset + f);
  }
}

// up = 1: the part above the cut is kept (a); up = -1: below it (b).
template <int up>
std::uint64_t kept_vertices(const ConvexView& v, const Side& s, double cut) {
  std::uint64_t bits = 0;
  for (int k = 0; k < v.padded; k += 8) {
    const Eight z = Eight::load(s.z + k), c(cut);
    bits |= std::uint64_t(up > 0 ? less(c, z) : less(z, c)) << k;
  }
  return bits & first_bits(v.vertices);
}

void add_corner(Side& s, int i) {
  const int k = s.corners++;
  s.px[k] = s.x[i], s.py[k] = s.y[i], s.pz[k] = s.z[i];
}

void add_crossing(Side& s, int i, int j, double cut) {
  const int k = s.corners++;
  const double t = (s.z[i] - cut) / (s.z[i] - s.z[j]);
  s.px[k] = s.x[i] + t * (s.x[j] - s.x[i]), s.py[k] = s.y[i] + t * (s.y[j] - s.y[i]);
  s.pz[k] = cut;
}

// The vertices inside the slab and the faces that reach into it.
template <int up>
void slab_part(const ConvexView& v, double cut, Side& s) {
  s.kept = kept_vertices<up>(v, s, cut);
  if (v.vertex_faces) {
    for (std::uint64_t rest = s.kept; rest; rest &= rest - 1)
      s.faces |= v.vertex_faces[__builtin_ctzll(rest)];
    return;
  }
  for (int f = 0; f < v.faces; ++f)
    for (int k = v.loop_begin[f]; k < v.loop_begin[f + 1]; ++k)
      s.faces |= (s.kept >> v.loop[k] & 1) << f;
}

// The corners of the slab's part.
void slab_corners(const ConvexView& v, double cut, Side& s) {
  for (std::uint64_t rest = s.kept; rest; rest &= rest - 1) {
    const int i = __builtin_ctzll(rest);
    add_corner(s, i);
    if (!v.neighbor) continue;
    for (int k = v.neighbor_begin[i]; k < v.neighbor_begin[i + 1]; ++k)
      if (!(s.kept >> v.neighbor[k] & 1)) add_crossing(s, i, v.neighbor[k], cut);
  }
  if (v.neighbor) return;
  for (int f = 0; f < v.faces; ++f)
    for (int begin = v.loop_begin[f], end = v.loop_begin[f + 1], k = begin; k < end; ++k) {
      const int i = v.loop[k], j = v.loop[k + 1 < end ? k + 1 : begin];
      // Its other face sees the edge from j to i.
      if ((s.kept >> i & 1) && !(s.kept >> j & 1)) add_crossing(s, i, j, cut);
    }
}

// Leaves the faces whose planes the other body's part may reach.
void cull_faces(Side& s, const Side& other, double slack) {
  for (int f = 0; f < kMost; f += 8) {
    const std::uint64_t block = s.faces >> f;
    if (!block) break;
    if (!(block & 255)) continue;
    const Eight nx = Eight::load(s.nx + f), ny = Eight::load(s.ny + f), nz = Eight::load(s.nz + f);
    const Eight offset = Eight(0.0) - Eight::load(s.offset + f);
    Eight most(-1e300);
    for (int c = 0; c < other.corners; ++c)
      most = max(most, fma(nx, Eight(other.px[c]),
                           fma(ny, Eight(other.py[c]), fma(nz, Eight(other.pz[c]), offset))));
    s.faces &= ~(std::uint64_t(less(most, Eight(-slack))) << f);
  }
}

[[gnu::always_inline]] inline bool face_polygon(const PlacedBody& body, const Side& s, int f,
                                                Polygon& p) {
  const ConvexView& v = body.view;
  const int begin = v.loop_begin[f];
  p.n = v.loop_begin[f + 1] - begin;
  if (p.n > 8) return false;
  if (v.corners) {
    p.of(body.M, body.t, v.corners + 24 * f);
    return true;
  }
  double x[8], y[8], z[8];
  for (int k = 0; k < 8; ++k) {
    const int i = v.loop[begin + (k < p.n ? k : p.n - 1)];
    x[k] = s.x[i], y[k] = s.y[i], z[k] = s.z[i];
  }
  p.x = Eight::load(x), p.y = Eight::load(y), p.z = Eight::load(z);
  return true;
}

// Clips one body's faces by the other's planes and appends what is left. Where faces of both
// coincide, a's is kept (up > 0) and b's is dropped. False: a polygon grew too large.
template <int up>
bool add_pieces(const PlacedBody& body, const Side& own, const Side& other, double cut,
                OverlapWorkspace& work, std::vector<OverlapPiece>& pieces) {
  const Eight zero(0.0);
  for (std::uint64_t rest = own.faces; rest; rest &= rest - 1) {
    const int f = __builtin_ctzll(rest);
    Polygon p;
    if (!face_polygon(body, own, f, p)) return false;
    const Eight below = up > 0 ? Eight(cut) - p.z : p.z - Eight(cut);
    if (!clip(p, below, less(below, zero))) return false;
    for (std::uint64_t planes = other.faces; planes && p.n; planes &= planes - 1) {
      const int j = __builtin_ctzll(planes);
      double nx = other.nx[j], ny = other.ny[j], nz = other.nz[j], offset = other.offset[j];
      if (nx * own.nx[f] + ny * own.ny[f] + nz * own.nz[f] > 1 - 1e-6) {  // see overlap.h
        nx -= own.nx[f], ny -= own.ny[f], nz -= own.nz[f], offset -= own.offset[f];
      }
      const Eight d = fma(Eight(nx), p.x, fma(Eight(ny), p.y, fma(Eight(nz), p.z, Eight(-offset))));
      if (!clip(p, d, up > 0 ? less_equal(d, zero) : less(d, zero))) return false;
    }
    if (p.n < 3) continue;
    alignas(64) double x[8], y[8], z[8];
    p.x.store(x), p.y.store(y), p.z.store(z);
    add_piece(f, p.n, x, y, z, work, pieces);
  }
  return true;
}

// The faces of the pieces appended, where an int has room for them and they are more than the four
// of a simple kind that was missed.
void note_faces(const PlacedBody& a, const PlacedBody& b, OverlapWorkspace& work) {
  work.feature = {};
  if (a.view.faces > 31 || b.view.faces > 31) return;
  if (work.a_pieces.size() + work.b_pieces.size() <= 4) return;
  for (const OverlapPiece& piece : work.a_pieces) work.feature.faces_a |= 1 << piece.face;
  for (const OverlapPiece& piece : work.b_pieces) work.feature.faces_b |= 1 << piece.face;
}

// All corners of the pieces lie inside these faces of the other body; adds the pieces' areas.
bool inside(const Side& s, std::uint64_t faces, double slack, const OverlapWorkspace& work,
            const std::vector<OverlapPiece>& pieces, Vec3& area) {
  std::uint64_t outside = 0;
  for (const OverlapPiece& piece : pieces) {
    area += piece.area;
    for (int f = 0; f < kMost && faces >> f; f += 8) {
      const Eight nx = Eight::load(s.nx + f), ny = Eight::load(s.ny + f),
                  nz = Eight::load(s.nz + f), limit = Eight::load(s.offset + f) + Eight(slack);
      unsigned bits = 0;
      for (int k = piece.first; k < piece.first + piece.count; ++k) {
        const Vec3& p = work.points[k];
        bits |= less(limit, fma(nx, Eight(p.x()), fma(ny, Eight(p.y()), nz * Eight(p.z()))));
      }
      outside |= std::uint64_t(bits) << f;
    }
  }
  return (outside & faces) == 0;
}

}  // namespace

bool clip_faces(const PlacedBody& a, const PlacedBody& b, const OverlapFeature& feature,
                OverlapWorkspace& work) {
  if (!a.view.corners || !b.view.corners || !suitable(a.view) || !suitable(b.view)) return false;
  constexpr double kNoCut = 1e300;
  Side side_a, side_b;
  planes_to_frame(a, side_a);
  planes_to_frame(b, side_b);
  side_a.faces = static_cast<unsigned>(feature.faces_a);
  side_b.faces = static_cast<unsigned>(feature.faces_b);
  if (!add_pieces<1>(a, side_a, side_b, -kNoCut, work, work.a_pieces) ||
      !add_pieces<-1>(b, side_b, side_a, kNoCut, work, work.b_pieces))
    return false;
  const double slack = 1e-15 * (a.view.radius + b.view.radius);
  Vec3 area_a = Vec3::Zero(), area_b = Vec3::Zero();
  if (!inside(side_b, face_bits(b.view) & ~side_b.faces, slack, work, work.a_pieces, area_a) ||
      !inside(side_a, face_bits(a.view) & ~side_a.faces, slack, work, work.b_pieces, area_b))
    return false;
  if (!((area_a + area_b).squaredNorm() <= 1e-18 * area_a.squaredNorm())) return false;
  note_faces(a, b, work);
  return true;
}

Clipped clip_small(const PlacedBody& a, const PlacedBody& b, OverlapWorkspace& work) {
  if (!suitable(a.view) || !suitable(b.view)) return Clipped::too_large;
  Side side_a, side_b;
  vertices_to_frame(a, side_a);
  vertices_to_frame(b, side_b);
  const SlabCut cut(a, b, side_a.high, side_b.low);
  if (!cut.overlap) return Clipped::nothing;
  slab_part<1>(a.view, cut.a, side_a);
  slab_part<-1>(b.view, cut.b, side_b);
  planes_to_frame(a, side_a);
  planes_to_frame(b, side_b);
  slab_corners(a.view, cut.a, side_a);
  slab_corners(b.view, cut.b, side_b);
  cull_faces(side_a, side_b, cut.slack);
  cull_faces(side_b, side_a, cut.slack);
  const Clipped simple = clip_simple(a, side_a, b, side_b, work);
  if (simple != Clipped::nothing) return simple;
  if (!add_pieces<1>(a, side_a, side_b, cut.a, work, work.a_pieces) ||
      !add_pieces<-1>(b, side_b, side_a, cut.b, work, work.b_pieces))
    return Clipped::too_large;
  note_faces(a, b, work);
  return Clipped::pieces;
}

}  // namespace trackbed::dem
