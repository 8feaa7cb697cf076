#include "dem/contact/flat_overlap.h"

#include <algorithm>

#include "dem/contact/polygon_clip.h"

namespace trackbed::dem {
namespace {

constexpr double kParallel = 1 - 1e-6;  // cosine from which walls may coincide

// A flat part in frame coordinates. Planes: of its walls, wall k from corner k to k + 1, and last
// of its outer face; normals of walls are as long as their edges. The half space below a face
// has no walls.
struct Flat {
  Polygon top, low;                                       // outer face; as far below as may matter
  alignas(64) double x[16], y[16], z[16];                 // corners of both, from 0 and from 8 on
  alignas(64) double nx[16], ny[16], nz[16], offset[16];  // planes
  int corners, walls;
  unsigned all;  // a bit for each corner
};

void take_corners(const Polygon& p, int at, Flat& flat) {
  p.x.store(flat.x + at), p.y.store(flat.y + at), p.z.store(flat.z + at);
}

// The corner after each.
Eight next(const double* x, int corners) {
  double wrapped[16];
  Eight::load(x).store(wrapped);
  wrapped[corners] = x[0];
  return Eight::load(wrapped + 1);
}

// Corners of a prism's base as in ConvexView::corners; returns how many.
int gather(const ConvexView& v, const FlatFace& on, double* corners) {
  const int first = v.loop_begin[on.face], all = v.loop_begin[on.face + 1] - first;
  const int skipped = on.prism * (kFlatCorners - 2), count = std::min(all - skipped, kFlatCorners);
  for (int k = 0; k < 8; ++k) {
    const int c = std::min(k, count - 1), i = v.loop[first + (c == 0 ? 0 : skipped + c)];
    corners[k] = v.x[i], corners[8 + k] = v.y[i], corners[16 + k] = v.z[i];
  }
  return count;
}

void make_flat(const PlacedBody& body, const FlatFace& on, double thickness, bool walls,
               Flat& out) {
  const ConvexView& v = body.view;
  const int f = on.face;
  const Vec3 m = body.M * Vec3(v.nx[f], v.ny[f], v.nz[f]);
  const Vec3 up = body.t + on.height * m;
  const double* corners = v.corners;
  alignas(64) double gathered[24];
  const int all = v.loop_begin[f + 1] - v.loop_begin[f];
  if (corners && all <= kFlatCorners) {
    corners += 24 * f;
    out.corners = all;
  } else {
    out.corners = gather(v, on, gathered);
    corners = gathered;
  }
  out.top.n = out.low.n = out.corners;
  out.all = (1u << out.corners) - 1;
  out.walls = walls ? out.corners : 0;
  out.top.of(body.M, up, corners);
  const Eight mx(m.x()), my(m.y()), mz(m.z());
  const Polygon& top = out.top;
  out.low.x = top.x - Eight(thickness) * mx;
  out.low.y = top.y - Eight(thickness) * my;
  out.low.z = top.z - Eight(thickness) * mz;
  take_corners(top, 0, out), take_corners(out.low, 8, out);
  if (walls) {
    const Eight ex = next(out.x, out.corners) - top.x, ey = next(out.y, out.corners) - top.y,
                ez = next(out.z, out.corners) - top.z;
    const Eight wx = ey * mz - ez * my, wy = ez * mx - ex * mz, wz = ex * my - ey * mx;
    wx.store(out.nx), wy.store(out.ny), wz.store(out.nz);
    fma(wx, top.x, fma(wy, top.y, wz * top.z)).store(out.offset);
  }
  const int k = out.walls;
  out.nx[k] = m.x(), out.ny[k] = m.y(), out.nz[k] = m.z();
  out.offset[k] = v.offset[f] + on.height + m.dot(body.t);
}

Eight distance(const Flat& of, int plane, const Polygon& p) {
  return fma(
      Eight(of.nx[plane]), p.x,
      fma(Eight(of.ny[plane]), p.y, fma(Eight(of.nz[plane]), p.z, Eight(-of.offset[plane]))));
}

// Faces of both that coincide are a's (up > 0), as in overlap().
template <int up>
unsigned inside(const Eight& d) {
  return up > 0 ? less_equal(d, Eight(0.0)) : less(d, Eight(0.0));
}

unsigned of_next(unsigned bits, int corners) { return bits >> 1 | (bits & 1) << (corners - 1); }

// Where the corners of one flat part lie to the planes of the other.
struct Cuts {
  unsigned top[9], walls[9];  // by plane: top corners outside, walls with a corner outside
  unsigned left;              // walls that are not wholly outside of a plane
  bool apart = false;

  template <int up>
  void find(const Flat& own, const Flat& other) {
    left = own.walls ? own.all : 0;
    for (int j = 0; j <= other.walls; ++j) {
      const unsigned high = own.all & ~inside<up>(distance(other, j, own.top)),
                     low = own.all & ~inside<up>(distance(other, j, own.low));
      apart |= (high & low) == own.all;
      top[j] = high;
      const unsigned high2 = of_next(high, own.corners), low2 = of_next(low, own.corners);
      walls[j] = high | low | high2 | low2;
      left &= ~(high & low & high2 & low2);
    }
  }
};

bool walls_may_coincide(const Flat& a, unsigned walls_a, const Flat& b, unsigned walls_b) {
  if (!walls_a || !walls_b) return false;
  const Eight nx = Eight::load(b.nx), ny = Eight::load(b.ny), nz = Eight::load(b.nz),
              least = Eight(kParallel * kParallel) * fma(nx, nx, fma(ny, ny, nz * nz));
  unsigned parallel = 0;
  for (; walls_a; walls_a &= walls_a - 1) {
    const int k = __builtin_ctz(walls_a);
    const double x = a.nx[k], y = a.ny[k], z = a.nz[k], length2 = x * x + y * y + z * z;
    const Eight dot = fma(Eight(x), nx, fma(Eight(y), ny, Eight(z) * nz));
    parallel |= less(Eight(length2) * least, dot * dot) & less(Eight(0.0), dot);
  }
  return parallel & walls_b;
}

void add_polygon(int face, const Polygon& p, OverlapWorkspace& work,
                 std::vector<OverlapPiece>& pieces) {
  alignas(64) double x[8], y[8], z[8];
  p.x.store(x), p.y.store(y), p.z.store(z);
  add_piece(face, p.n, x, y, z, work, pieces);
}

// Cuts by the planes of which bits are set. False: too many corners.
template <int up>
bool cut(Polygon& p, const Flat& by, unsigned planes) {
  for (; planes && p.n; planes &= planes - 1) {
    const Eight d = distance(by, __builtin_ctz(planes), p);
    if (!clip(p, d, inside<up>(d))) return false;
  }
  return true;
}

template <int up>
bool add_pieces(const Flat& own, const Flat& other, const Cuts& cuts, OverlapWorkspace& work,
                std::vector<OverlapPiece>& pieces) {
  const int n = own.corners;
  unsigned planes = 0;
  bool outside = false;
  for (int j = 0; j <= other.walls; ++j) {
    planes |= unsigned(cuts.top[j] != 0) << j;
    outside |= cuts.top[j] == own.all;
  }
  if (!outside) {
    Polygon p = own.top;
    if (!cut<up>(p, other, planes)) return false;
    if (p.n >= 3) add_polygon(0, p, work, pieces);
  }
  for (unsigned rest = cuts.left; rest; rest &= rest - 1) {
    const int k = __builtin_ctz(rest), l = k + 1 < n ? k + 1 : 0;
    const auto strip = [k, l](const double* x) {
      alignas(64) const double corner[8] = {x[8 + k], x[8 + l], x[l], x[k], x[k], x[k], x[k], x[k]};
      return Eight::load(corner);
    };
    Polygon p{strip(own.x), strip(own.y), strip(own.z), 4};
    planes = 0;
    for (int j = 0; j <= other.walls; ++j) planes |= (cuts.walls[j] >> k & 1) << j;
    if (!cut<up>(p, other, planes)) return false;
    if (p.n >= 3) add_polygon(2 + k, p, work, pieces);
  }
  return true;
}

// Whether a flat part, as far as it may matter, lies inside all planes of a plain polyhedron but
// that of one face.
bool others_are_clear(const PlacedBody& plain, int face, const Flat& flat) {
  const ConvexView& v = plain.view;
  const Mat3& M = plain.M;
  const Eight zero(0.0);
  std::uint64_t outside = 0;
  for (int f = 0; f < v.faces; f += 8) {
    const Eight x = Eight::load(v.nx + f), y = Eight::load(v.ny + f), z = Eight::load(v.nz + f);
    const Eight nx = row(M, 0, x, y, z, zero), ny = row(M, 1, x, y, z, zero),
                nz = row(M, 2, x, y, z, zero);
    const Eight limit =
        fma(nx, Eight(plain.t.x()),
            fma(ny, Eight(plain.t.y()), fma(nz, Eight(plain.t.z()), Eight::load(v.offset + f))));
    unsigned bits = 0;
    for (int from = 0; from <= 8; from += 8)
      for (int k = from; k < from + flat.corners; ++k)
        bits |= less_equal(
            limit, fma(nx, Eight(flat.x[k]), fma(ny, Eight(flat.y[k]), nz * Eight(flat.z[k]))));
    outside |= std::uint64_t(bits) << f;
  }
  const std::uint64_t faces = v.faces >= 64 ? ~std::uint64_t(0) : (std::uint64_t(1) << v.faces) - 1;
  return (outside & faces & ~(std::uint64_t(1) << face)) == 0;
}

}  // namespace

bool clip_flats(const PlacedBody& a, const FlatFace& on_a, const PlacedBody& b,
                const FlatFace& on_b, double thickness, OverlapWorkspace& work) {
  for (const PlacedBody* body : {&a, &b})
    if (body->view.faces > 64 || !body->view.planes_padded) return false;
  Flat flat_a, flat_b;
  make_flat(a, on_a, thickness, on_a.height > 0, flat_a);
  make_flat(b, on_b, thickness, on_b.height > 0, flat_b);
  if (!(on_a.height > 0) && !others_are_clear(a, on_a.face, flat_b)) return false;
  if (!(on_b.height > 0) && !others_are_clear(b, on_b.face, flat_a)) return false;
  Cuts of_a, of_b;
  of_a.find<1>(flat_a, flat_b);
  of_b.find<-1>(flat_b, flat_a);
  if (of_a.apart || of_b.apart) return true;
  if (walls_may_coincide(flat_a, of_a.left, flat_b, of_b.left)) return false;
  return add_pieces<1>(flat_a, flat_b, of_a, work, work.a_pieces) &&
         add_pieces<-1>(flat_b, flat_a, of_b, work, work.b_pieces);
}

}  // namespace trackbed::dem
