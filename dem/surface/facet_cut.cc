#include "dem/surface/facet_cut.h"

#include <algorithm>
#include <cmath>

#include "dem/contact/cone_sums.h"
#include "dem/contact/eight.h"
#include "dem/contact/overlap_simple.h"
#include "dem/contact/simple_contact.h"

namespace trackbed::dem {
namespace {

constexpr int kCorners = 16, kFaces = 24;
constexpr int kSurface = -1, kSide = -2;  // faces that are none of the grain's

struct Polygon {
  int face = 0, n = 0;
  Vec3 p[kCorners];
};

struct Cap {
  Polygon polygon[kFaces];
  int polygons = 0;
};

/// Edges of a closing polygon, each from where a face's boundary comes back to where it left.
struct Rim {
  Vec3 from[kFaces], to[kFaces];
  int n = 0;
};

/// Links the edges, whose ends are the same to the last bit, to one loop.
bool close(Rim& rim, int face, Cap& cap) {
  if (rim.n < 3 || rim.n > kCorners || cap.polygons == kFaces) return rim.n == 0;
  Polygon& loop = cap.polygon[cap.polygons++];
  loop.face = face, loop.n = rim.n;
  for (int k = 0; k < rim.n; ++k) {
    loop.p[k] = rim.from[k];
    int next = k + 1;
    while (next < rim.n && rim.from[next] != rim.to[k]) ++next;
    if (k + 1 == rim.n) return rim.to[k] == rim.from[0];
    if (next == rim.n) return false;
    std::swap(rim.from[k + 1], rim.from[next]), std::swap(rim.to[k + 1], rim.to[next]);
  }
  return true;
}

/// The part of a polygon where `height` < 0, by corner; a crossing is always reckoned from the
/// lower end, so that both faces at an edge have the same.
template <class Corner, class Height>
bool cut(int corners, Corner&& corner, Height&& height, Polygon& out, Rim& rim) {
  out.n = 0;
  const Vec3 *left = nullptr, *back = nullptr;
  int crossings = 0;
  for (int i = 0; i < corners; ++i) {
    const int j = i + 1 == corners ? 0 : i + 1;
    const double hi = height(i), hj = height(j);
    if (out.n + 2 > kCorners) return false;
    if (hi < 0) out.p[out.n++] = corner(i);
    if ((hi < 0) == (hj < 0)) continue;
    ++crossings;
    const int low = hi < 0 ? i : j, high = hi < 0 ? j : i;
    const double hl = hi < 0 ? hi : hj, hh = hi < 0 ? hj : hi;
    const Vec3 p = corner(low), q = corner(high);
    (hi < 0 ? left : back) = &out.p[out.n];
    out.p[out.n++] = p + hl / (hl - hh) * (q - p);
  }
  if (crossings == 0) return true;
  if (crossings != 2 || rim.n == kFaces) return false;
  rim.from[rim.n] = *back, rim.to[rim.n++] = *left;
  return true;
}

/// The grain's cap below the surface, closed.
bool make_cap(const ConvexView& grain, const GrainBelow& at, const Mat3& M, const Vec3& t,
              Cap& cap) {
  Vec3 place[GrainBelow::kMost];
  std::uint64_t placed = 0, faces = 0;
  for (std::uint64_t rest = at.below; rest; rest &= rest - 1)
    faces |= grain.vertex_faces[__builtin_ctzll(rest)];
  const auto vertex = [&](int v) -> const Vec3& {
    if (!(placed >> v & 1)) {
      place[v] = M * Vec3(grain.x[v], grain.y[v], grain.z[v]) + t;
      placed |= std::uint64_t(1) << v;
    }
    return place[v];
  };
  Rim rim;
  for (; faces; faces &= faces - 1) {
    const int f = __builtin_ctzll(faces), begin = grain.loop_begin[f];
    if (cap.polygons == kFaces) return false;
    Polygon& out = cap.polygon[cap.polygons++];
    out.face = f;
    if (!cut(
            grain.loop_begin[f + 1] - begin,
            [&](int i) -> const Vec3& { return vertex(grain.loop[begin + i]); },
            [&](int i) { return at.height[grain.loop[begin + i]]; }, out, rim))
      return false;
  }
  return rim.n > 0 && close(rim, kSurface, cap);
}

/// Keeps what lies inside a plane (frame coordinates). False: cannot tell.
bool cut_cap(const Vec3& normal, double offset, Cap& cap) {
  Cap kept;
  Rim rim;
  for (int f = 0; f < cap.polygons; ++f) {
    const Polygon& polygon = cap.polygon[f];
    double height[kCorners];
    for (int i = 0; i < polygon.n; ++i) height[i] = normal.dot(polygon.p[i]) - offset;
    Polygon& out = kept.polygon[kept.polygons];
    out.face = polygon.face;
    if (!cut(
            polygon.n, [&](int i) -> const Vec3& { return polygon.p[i]; },
            [&](int i) { return height[i]; }, out, rim))
      return false;
    if (out.n > 0) ++kept.polygons;
  }
  if (!close(rim, kSide, kept)) return false;
  cap.polygons = kept.polygons;
  for (int f = 0; f < kept.polygons; ++f) {
    cap.polygon[f].face = kept.polygon[f].face, cap.polygon[f].n = kept.polygon[f].n;
    std::copy(kept.polygon[f].p, kept.polygon[f].p + kept.polygon[f].n, cap.polygon[f].p);
  }
  return true;
}

/// How far the cap's corners lie outside a plane: the least and the most.
struct Reach {
  double least = HUGE_VAL, most = -HUGE_VAL;
  Reach(const Cap& cap, const Vec3& normal, double offset) {
    for (int f = 0; f < cap.polygons; ++f)
      for (int i = 0; i < cap.polygon[f].n; ++i) {
        const double h = normal.dot(cap.polygon[f].p[i]) - offset;
        least = std::min(least, h), most = std::max(most, h);
      }
  }
};

/// The facet's planes (Facet::planes, as bits) that some corner of the cap lies outside of. `M`,
/// `origin`: from the facet's place to the frame.
unsigned planes_passed(const Cap& cap, const Facet& facet, const Mat3& M, const Vec3& origin) {
  const Eight nx = Eight::load(facet.nx), ny = Eight::load(facet.ny), nz = Eight::load(facet.nz);
  const auto row = [&](int r) {
    return fma(Eight(M(r, 0)), nx, fma(Eight(M(r, 1)), ny, Eight(M(r, 2)) * nz));
  };
  const Eight x = row(0), y = row(1), z = row(2);
  const auto along = [&](const Vec3& p, Eight start) {
    return fma(x, Eight(p.x()), fma(y, Eight(p.y()), fma(z, Eight(p.z()), start)));
  };
  const Eight limit = along(origin, Eight::load(facet.offset)), zero(0.0);
  unsigned passed = 0;
  for (int f = 0; f < cap.polygons; ++f)
    for (int i = 0; i < cap.polygon[f].n; ++i)
      passed |= less(limit, along(cap.polygon[f].p[i], zero));
  return passed;
}

void append(const Cap& cap, OverlapWorkspace& work) {
  for (int f = 0; f < cap.polygons; ++f) {
    const Polygon& polygon = cap.polygon[f];
    if (polygon.face == kSide || polygon.n < 3) continue;
    Vec3 area = Vec3::Zero();
    for (int i = 2; i < polygon.n; ++i)
      area += 0.5 * (polygon.p[i - 1] - polygon.p[0]).cross(polygon.p[i] - polygon.p[0]);
    const bool surface = polygon.face == kSurface;
    (surface ? work.b_pieces : work.a_pieces)
        .push_back(
            {surface ? 0 : polygon.face, static_cast<int>(work.points.size()), polygon.n, area});
    work.points.insert(work.points.end(), polygon.p, polygon.p + polygon.n);
  }
}

bool sum_moments(const Cap& cap, OverlapMoments& moments) {
  Vec3 sum = Vec3::Zero();
  int count = 0;
  for (int f = 0; f < cap.polygons; ++f)
    for (int i = 0; i < cap.polygon[f].n; ++i, ++count) sum += cap.polygon[f].p[i];
  ConeSums cones;
  moments = {};
  moments.about = sum / std::max(count, 1);
  for (int f = 0; f < cap.polygons; ++f)
    if (cap.polygon[f].n >= 3) cones.add(cap.polygon[f].p, cap.polygon[f].n, moments.about);
  if (!(cones.six > 0)) return false;
  cones.add_to(moments);
  return true;
}

}  // namespace

bool find_below(const ConvexView& grain, const Pose& pose, const Facet& facet, GrainBelow& at) {
  const Vec3 n = pose.R.transpose() * facet.normal;
  const double t = facet.normal.dot(pose.x - facet.origin);
  at.below = 0, at.lowest = HUGE_VAL;
  const auto lower = [&](double height, int v) {
    if (height < at.lowest) at.lowest = height, at.lowest_vertex = v;
  };
  if (grain.padded > GrainBelow::kMost || grain.padded % 8 != 0 || grain.faces > 64 ||
      !grain.vertex_faces || grain.face_words != 1) {
    for (int v = 0; v < grain.vertices; ++v)
      lower(n.dot(Vec3(grain.x[v], grain.y[v], grain.z[v])) + t, v);
    return false;
  }
  const Eight nx(n.x()), ny(n.y()), nz(n.z()), zero(0.0);
  for (int k = 0; k < grain.padded; k += 8) {
    const Eight h =
        fma(nx, Eight::load(grain.x + k),
            fma(ny, Eight::load(grain.y + k), fma(nz, Eight::load(grain.z + k), Eight(t))));
    h.store(at.height + k);
    at.below |= std::uint64_t(less(h, zero)) << k;
  }
  if (grain.vertices < 64) at.below &= (std::uint64_t(1) << grain.vertices) - 1;
  for (std::uint64_t rest = at.below; rest; rest &= rest - 1) {
    const int v = __builtin_ctzll(rest);
    lower(at.height[v], v);
  }
  if (at.below == 0) at.lowest = 0, at.lowest_vertex = 0;
  return true;
}

bool vertex_behind_facet(const ConvexView& grain, const Pose& pose, const Facet& facet,
                         const GrainBelow& at, ContactFrame& frame, OverlapWorkspace& work,
                         OverlapMoments& moments) {
  SimpleContact c;
  if (at.below != std::uint64_t(1) << at.lowest_vertex || !grain.stars ||
      !vertex_in_face(grain, pose, at.lowest_vertex, facet.planes(),
                      {Mat3::Identity(), facet.origin}, 0, kLeastRise * grain.radius, c))
    return false;
  frame = c.frame;
  moments = {};
  moments.volume = c.shape.volume;
  moments.about = c.shape.centroid;
  moments.second = c.shape.second_moment;
  work.b_pieces.push_back({0, static_cast<int>(work.points.size()), c.corners, c.shape.area});
  work.points.insert(work.points.end(), c.corner, c.corner + c.corners);
  work.points.push_back(Vec3::Zero());
  return true;
}

FacetOverlap cut_behind_facet(const ConvexView& grain, const Pose& pose, const Facet& facet,
                              const GrainBelow& at, const ContactFrame& frame,
                              OverlapWorkspace& work, OverlapMoments& moments) {
  if (!(at.lowest < -1e-15 * grain.radius)) return FacetOverlap::none;
  if (-at.lowest > facet.depth) return FacetOverlap::not_for_one_facet;
  const Mat3 to_frame = frame.axes.transpose();
  static thread_local Cap cap;
  cap.polygons = 0;
  if (!make_cap(grain, at, to_frame * pose.R, to_frame * (pose.x - frame.origin), cap))
    return FacetOverlap::not_for_one_facet;
  const Vec3 origin = to_frame * (facet.origin - frame.origin);
  const unsigned passed = planes_passed(cap, facet, to_frame, origin);
  for (int k = 0; k < 3; ++k) {
    if ((passed >> (1 + 2 * k) & 3) == 0) continue;  // both planes of the side
    const Facet::Side& side = facet.side[k];
    Vec3 normal = to_frame * side.normal[0];
    double offset = side.offset[0] + normal.dot(origin);
    const Reach reach(cap, normal, offset);
    if (!side.plane) {
      const Vec3 other = to_frame * side.normal[1];
      if (reach.most <= 0 && Reach(cap, other, side.offset[1] + other.dot(origin)).most <= 0)
        continue;
      return FacetOverlap::not_for_one_facet;
    }
    if (reach.most <= 0) continue;
    if (reach.least >= 0) return FacetOverlap::none;
    if (!cut_cap(normal, offset, cap)) return FacetOverlap::not_for_one_facet;
  }
  if (!sum_moments(cap, moments)) return FacetOverlap::none;
  append(cap, work);
  return FacetOverlap::cut;
}

}  // namespace trackbed::dem
