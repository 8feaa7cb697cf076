// Clipping of bodies of any size; see overlap.h for the method.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "dem/contact/overlap_clip.h"

namespace trackbed::dem {
namespace {

using Cap = OverlapWorkspace::Cap;
using Polygon = OverlapWorkspace::Polygon;

void grow(std::vector<double>& v, int n) {
  if (static_cast<int>(v.size()) < n) v.resize(2 * n);
}

void grow(Polygon& p, int n) { grow(p.x, n), grow(p.y, n), grow(p.z, n); }

// All vertices in frame coordinates; returns the highest and lowest z.
std::pair<double, double> to_frame(const ConvexView& v, const Mat3& M, const Vec3& t, Cap& cap) {
  grow(cap.x, v.vertices), grow(cap.y, v.vertices), grow(cap.z, v.vertices);
  double high = -std::numeric_limits<double>::infinity(), low = -high;
  for (int i = 0; i < v.vertices; ++i) {
    const double x = v.x[i], y = v.y[i], z = v.z[i];
    cap.x[i] = M(0, 0) * x + M(0, 1) * y + M(0, 2) * z + t.x();
    cap.y[i] = M(1, 0) * x + M(1, 1) * y + M(1, 2) * z + t.y();
    cap.z[i] = M(2, 0) * x + M(2, 1) * y + M(2, 2) * z + t.z();
    high = std::max(high, cap.z[i]), low = std::min(low, cap.z[i]);
  }
  return {high, low};
}

void add_corner(Cap& cap, double x, double y, double z) {
  const int k = cap.corners++;
  cap.px[k] = x, cap.py[k] = y, cap.pz[k] = z;
}

// The side of the cut that is kept: above it for a (up = 1), below it for b (up = -1).
template <int up>
bool kept(double z, double cut) {
  return up > 0 ? z > cut : z < cut;
}

// The corners of the body's part on the kept side of the cut, and the faces that reach into it.
template <int up>
void slab_part(const ConvexView& v, double cut, Cap& cap) {
  cap.corners = cap.faces = 0;
  const int corners = v.loop_begin[v.faces];
  grow(cap.px, v.vertices + corners), grow(cap.py, v.vertices + corners);
  grow(cap.pz, v.vertices + corners);
  if (static_cast<int>(cap.face.size()) < v.faces) cap.face.resize(2 * v.faces);

  const auto cross = [&](int i, int j) {  // i is kept, j is not
    const double s = (cap.z[i] - cut) / (cap.z[i] - cap.z[j]);
    add_corner(cap, cap.x[i] + s * (cap.x[j] - cap.x[i]), cap.y[i] + s * (cap.y[j] - cap.y[i]),
               cut);
  };
  if (v.vertex_faces && v.neighbor) {
    std::vector<std::uint64_t>& bits = cap.bits;
    if (static_cast<int>(bits.size()) < v.face_words) bits.resize(v.face_words);
    std::fill_n(bits.begin(), v.face_words, 0);
    for (int i = 0; i < v.vertices; ++i) {
      if (!kept<up>(cap.z[i], cut)) continue;
      add_corner(cap, cap.x[i], cap.y[i], cap.z[i]);
      for (int w = 0; w < v.face_words; ++w) bits[w] |= v.vertex_faces[i * v.face_words + w];
      for (int k = v.neighbor_begin[i]; k < v.neighbor_begin[i + 1]; ++k)
        if (!kept<up>(cap.z[v.neighbor[k]], cut)) cross(i, v.neighbor[k]);
    }
    for (int w = 0; w < v.face_words; ++w)
      for (std::uint64_t rest = bits[w]; rest; rest &= rest - 1)
        cap.face[cap.faces++] = 64 * w + __builtin_ctzll(rest);
  } else {
    for (int f = 0; f < v.faces; ++f) {
      const int begin = v.loop_begin[f], end = v.loop_begin[f + 1];
      bool reaches = false;
      for (int k = begin; k < end; ++k) {
        const int i = v.loop[k], j = v.loop[k + 1 < end ? k + 1 : begin];
        const bool i_kept = kept<up>(cap.z[i], cut), j_kept = kept<up>(cap.z[j], cut);
        if (i_kept) add_corner(cap, cap.x[i], cap.y[i], cap.z[i]);
        if (i_kept != j_kept) i_kept ? cross(i, j) : cross(j, i);
        reaches = reaches || i_kept;
      }
      if (reaches) cap.face[cap.faces++] = f;
    }
  }
}

void planes_to_frame(const ConvexView& v, const Mat3& M, const Vec3& t, Cap& cap) {
  const int n = cap.faces;
  grow(cap.nx, n), grow(cap.ny, n), grow(cap.nz, n), grow(cap.offset, n);
  grow(cap.most, n), grow(cap.least, n);
  for (int k = 0; k < n; ++k) {
    const int f = cap.face[k];
    const double x = v.nx[f], y = v.ny[f], z = v.nz[f];
    cap.nx[k] = M(0, 0) * x + M(0, 1) * y + M(0, 2) * z;
    cap.ny[k] = M(1, 0) * x + M(1, 1) * y + M(1, 2) * z;
    cap.nz[k] = M(2, 0) * x + M(2, 1) * y + M(2, 2) * z;
    cap.offset[k] = v.offset[f] + cap.nx[k] * t.x() + cap.ny[k] * t.y() + cap.nz[k] * t.z();
  }
}

// Keeps the planes of `cap` that the other body's part may reach. False if one separates the two.
bool cull_planes(Cap& cap, const Cap& other, double slack) {
  const int n = cap.faces;
  std::fill_n(cap.most.begin(), n, -std::numeric_limits<double>::infinity());
  std::fill_n(cap.least.begin(), n, std::numeric_limits<double>::infinity());
  for (int c = 0; c < other.corners; ++c) {
    const double x = other.px[c], y = other.py[c], z = other.pz[c];
    for (int k = 0; k < n; ++k) {
      const double d = cap.nx[k] * x + cap.ny[k] * y + cap.nz[k] * z - cap.offset[k];
      cap.most[k] = d > cap.most[k] ? d : cap.most[k];
      cap.least[k] = d < cap.least[k] ? d : cap.least[k];
    }
  }
  int m = 0;
  for (int k = 0; k < n; ++k) {
    if (cap.least[k] >= 0) return false;
    if (cap.most[k] < -slack) continue;
    cap.nx[m] = cap.nx[k], cap.ny[m] = cap.ny[k], cap.nz[m] = cap.nz[k];
    cap.offset[m] = cap.offset[k], cap.face[m] = cap.face[k];
    ++m;
  }
  cap.faces = m;
  return true;
}

// The part of face f on the kept side of the cut.
template <int up>
void face_polygon(const ConvexView& v, int f, double cut, const Cap& cap, Polygon& out) {
  const int begin = v.loop_begin[f], end = v.loop_begin[f + 1];
  out.n = 0;
  const auto push = [&out](double x, double y, double z) {
    out.x[out.n] = x, out.y[out.n] = y, out.z[out.n] = z;
    ++out.n;
  };
  int i = v.loop[end - 1];
  for (int k = begin; k < end; ++k) {
    const int j = v.loop[k];
    const bool i_kept = kept<up>(cap.z[i], cut), j_kept = kept<up>(cap.z[j], cut);
    if (i_kept != j_kept) {
      const int p = i_kept ? i : j, q = i_kept ? j : i;
      const double s = (cap.z[p] - cut) / (cap.z[p] - cap.z[q]);
      push(cap.x[p] + s * (cap.x[q] - cap.x[p]), cap.y[p] + s * (cap.y[q] - cap.y[p]), cut);
    }
    if (j_kept) push(cap.x[j], cap.y[j], cap.z[j]);
    i = j;
  }
}

// The part of a polygon where the signed distance is <= 0, or < 0 if `strict`.
template <bool strict>
void clip(const Polygon& in, const double* d, Polygon& out) {
  out.n = 0;
  const auto inside = [](double value) { return strict ? value < 0 : value <= 0; };
  int i = in.n - 1;
  for (int j = 0; j < in.n; ++j) {
    if (inside(d[i]) != inside(d[j])) {
      const int p = inside(d[i]) ? i : j, q = inside(d[i]) ? j : i;
      const double s = d[p] / (d[p] - d[q]);
      out.x[out.n] = in.x[p] + s * (in.x[q] - in.x[p]);
      out.y[out.n] = in.y[p] + s * (in.y[q] - in.y[p]);
      out.z[out.n] = in.z[p] + s * (in.z[q] - in.z[p]);
      ++out.n;
    }
    if (inside(d[j])) {
      out.x[out.n] = in.x[j], out.y[out.n] = in.y[j], out.z[out.n] = in.z[j];
      ++out.n;
    }
    i = j;
  }
}

// Clips the faces of one body by the planes of the other and appends what is left. Faces of both
// that coincide are kept when up > 0 (body a) and dropped otherwise.
template <int up>
void add_pieces(const ConvexView& v, double cut, const Cap& own, const Cap& other,
                OverlapWorkspace& work, std::vector<OverlapPiece>& pieces) {
  for (int k = 0; k < own.faces; ++k) {
    const int f = own.face[k];
    const int most = 2 * (v.loop_begin[f + 1] - v.loop_begin[f] + other.faces) + 2;
    grow(work.polygon[0], most), grow(work.polygon[1], most), grow(work.distance, most);
    int now = 0;
    face_polygon<up>(v, f, cut, own, work.polygon[0]);
    for (int j = 0; j < other.faces && work.polygon[now].n >= 3; ++j) {
      const Polygon& in = work.polygon[now];
      double nx = other.nx[j], ny = other.ny[j], nz = other.nz[j], offset = other.offset[j];
      if (nx * own.nx[k] + ny * own.ny[k] + nz * own.nz[k] > 1 - 1e-6) {  // see overlap.h
        nx -= own.nx[k], ny -= own.ny[k], nz -= own.nz[k], offset -= own.offset[k];
      }
      double* d = work.distance.data();
      double largest = -std::numeric_limits<double>::infinity();
      for (int i = 0; i < in.n; ++i) {
        d[i] = nx * in.x[i] + ny * in.y[i] + nz * in.z[i] - offset;
        largest = std::max(largest, d[i]);
      }
      if (largest < 0 || (up > 0 && largest == 0)) continue;
      clip<(up < 0)>(in, d, work.polygon[1 - now]);
      now = 1 - now;
    }
    const Polygon& left = work.polygon[now];
    if (left.n < 3) continue;
    add_piece(f, left.n, left.x.data(), left.y.data(), left.z.data(), work, pieces);
  }
}

}  // namespace

bool clip_any(const PlacedBody& a, const PlacedBody& b, OverlapWorkspace& work) {
  Cap &cap_a = work.cap_a, &cap_b = work.cap_b;
  const double high = to_frame(a.view, a.M, a.t, cap_a).first;
  const double low = to_frame(b.view, b.M, b.t, cap_b).second;
  const SlabCut cut(a, b, high, low);
  if (!cut.overlap) return false;
  slab_part<1>(a.view, cut.a, cap_a);
  slab_part<-1>(b.view, cut.b, cap_b);
  planes_to_frame(a.view, a.M, a.t, cap_a);
  planes_to_frame(b.view, b.M, b.t, cap_b);
  if (!cull_planes(cap_a, cap_b, cut.slack) || !cull_planes(cap_b, cap_a, cut.slack)) return false;
  add_pieces<1>(a.view, cut.a, cap_a, cap_b, work, work.a_pieces);
  add_pieces<-1>(b.view, cut.b, cap_b, cap_a, work, work.b_pieces);
  return true;
}

}  // namespace trackbed::dem
