#include "dem/contact/flat_cap.h"

#include <algorithm>

#include "dem/contact/cone_sums.h"
#include "dem/contact/eight.h"
#include "dem/contact/overlap_simple.h"

namespace trackbed::dem {
namespace {

// A flat part, or a plain body (height 0), in its body's frame.
struct Part {
  const ConvexView& v;
  const Pose pose;
  const FlatFace on;
  int corners;
  Vec3 normal, world_normal;
  const double* corner = nullptr;  // as ConvexView::corners
  alignas(64) double gathered[24];

  Part(const ConvexView& view, const Pose& p, const FlatFace& face)
      : v(view),
        pose(p),
        on(face),
        corners(v.loop_begin[face.face + 1] - v.loop_begin[face.face]),
        normal(v.nx[face.face], v.ny[face.face], v.nz[face.face]),
        world_normal(pose.R * normal) {
    if (!(on.height > 0) || corners > kFlatCorners) return;
    if (v.corners) {
      corner = v.corners + 24 * on.face;
      return;
    }
    const std::uint16_t* loop = v.loop + v.loop_begin[on.face];
    for (int k = 0; k < 8; ++k) {
      const int i = loop[std::min(k, corners - 1)];
      gathered[k] = v.x[i], gathered[8 + k] = v.y[i], gathered[16 + k] = v.z[i];
    }
    corner = gathered;
  }
  Part(const Part&) = delete;  // points into itself
  Part& operator=(const Part&) = delete;

  double offset() const { return v.offset[on.face] + on.height; }  // of the outer face
  bool suits() const {
    return on.height > 0 ? corner != nullptr : v.faces <= kMost && v.planes_padded;
  }
};

// M p + t of the outer face's corners.
struct Corners {
  alignas(64) double x[8], y[8], z[8];

  void of(const Part& part, const Mat3& M, const Vec3& t) {
    const double* c = part.corner;
    const Eight cx = Eight::load(c), cy = Eight::load(c + 8), cz = Eight::load(c + 16);
    const Vec3 up = t + M * (part.on.height * part.normal);
    double* out[3] = {x, y, z};
    for (int r = 0; r < 3; ++r)
      fma(Eight(M(r, 0)), cx, fma(Eight(M(r, 1)), cy, fma(Eight(M(r, 2)), cz, Eight(up[r]))))
          .store(out[r]);
  }
};

// Points in the other face's frame, at most two for each corner and two more.
struct Points {
  double x[16], y[16], z[16];
  int n = 0;
  int add(double px, double py, double pz) {
    x[n] = px, y[n] = py, z[n] = pz;
    return n++;
  }
  Vec3 at(int k) const { return {x[k], y[k], z[k]}; }
};

// Inside all planes but that of the face, `axes` and `origin` from the face's frame to the body's.
bool inside(const Part& other, const Mat3& axes, const Vec3& origin, const Points& p) {
  const ConvexView& v = other.v;
  std::uint64_t outside = 0;
  for (int f = 0; f < v.faces; f += 8) {
    const Eight nx = Eight::load(v.nx + f), ny = Eight::load(v.ny + f), nz = Eight::load(v.nz + f);
    unsigned bits = 0;
    for (int k = 0; k < p.n; ++k) {
      const Vec3 q = axes * p.at(k) + origin;
      bits |= less(Eight::load(v.offset + f),
                   fma(nx, Eight(q.x()), fma(ny, Eight(q.y()), nz * Eight(q.z()))));
    }
    outside |= std::uint64_t(bits) << f;
  }
  return (outside & ~(std::uint64_t(1) << other.on.face) & face_bits(v)) == 0;
}

// Inside the walls, which stand upright in the face's frame.
bool inside_walls(const Part& other, const Corners& c, const Points& p) {
  const int last = other.corners - 1;
  double nx[8], ny[8];
  for (int k = 0; k < 8; ++k) {
    const int i = std::min(k, last), j = i < last ? i + 1 : 0;
    nx[k] = c.y[j] - c.y[i], ny[k] = c.x[i] - c.x[j];
  }
  const Eight wx = Eight::load(nx), wy = Eight::load(ny),
              offset = fma(wx, Eight::load(c.x), wy * Eight::load(c.y));
  unsigned outside = 0;
  for (int k = 0; k < p.n; ++k) outside |= less(offset, fma(wx, Eight(p.x[k]), wy * Eight(p.y[k])));
  return (outside & ((1u << other.corners) - 1)) == 0;
}

// The cap of `own` below the other's face, of which the corners in `below` are tips.
bool cap_in_face(const Part& own, unsigned below, const Part& other, SimpleContact& out) {
  const unsigned all = (1u << own.corners) - 1;
  const unsigned first_bits = below & ~((below << 1 | below >> (own.corners - 1)) & all);
  if (below != all && (first_bits & (first_bits - 1))) return false;  // no chain: rounding
  const int tips = __builtin_popcount(below), begin = below == all ? 0 : __builtin_ctz(first_bits);
  const auto wrapped = [&own](int k) { return k % own.corners; };

  // Frame: the face's; about the first tip.
  const Mat3 of_face = axes_along(other.normal), axes = other.pose.R * of_face;
  const Mat3 M = axes.transpose() * own.pose.R;
  Corners c;
  c.of(own, M, Vec3::Zero());
  const Vec3 tip(c.x[begin], c.y[begin], c.z[begin]);  // from own's centre
  const Vec3 place = axes.transpose() * (own.pose.x - other.pose.x) + tip;
  const double top = other.offset() - place.z();  // of the plane
  const Vec3 down = -own.on.height * (M * own.normal);
  if (!(top > 0) || !(down.z() > 0)) return false;

  Points p;  // tips, what is above each, the border's two
  for (int k = 0; k < tips; ++k) {
    const int i = wrapped(begin + k);
    p.add(c.x[i] - tip.x(), c.y[i] - tip.y(), c.z[i] - tip.z());
    if (!(p.z[k] < top && top - p.z[k] < down.z())) return false;
  }
  const double up = 1 / down.z();
  for (int k = 0; k < tips; ++k) {
    const double t = (top - p.z[k]) * up;
    p.add(p.x[k] + t * down.x(), p.y[k] + t * down.y(), top);
  }
  Vec3 polygon[8];  // the cap's piece in the plane
  int n = 0;
  bool crosses = true;
  const auto cross = [&](int low, int high) {
    const Vec3 q(c.x[high] - tip.x(), c.y[high] - tip.y(), c.z[high] - tip.z());
    crosses &= q.z() >= top;
    const double t = (top - p.z[low]) / (q.z() - p.z[low]);
    return p.add(p.x[low] + t * (q.x() - p.x[low]), p.y[low] + t * (q.y() - p.y[low]), top);
  };
  const bool whole = below == all;
  int entry = 0, leave = 0;
  if (!whole) {
    leave = cross(tips - 1, wrapped(begin + tips));
    entry = cross(0, wrapped(begin + own.corners - 1));
    if (!crosses) return false;
    polygon[n++] = p.at(leave);
  }
  for (int k = tips; k-- > 0;) polygon[n++] = p.at(tips + k);
  if (!whole) polygon[n++] = p.at(entry);

  if (other.on.height > 0) {
    Corners walls;
    walls.of(other, of_face.transpose(), Vec3(-place));
    if (!inside_walls(other, walls, p)) return false;
  } else if (!inside(other, of_face, of_face * place, p)) {
    return false;
  }

  // Cones from the first tip; of the walls those that do not pass through it.
  ConeSums sum;
  const Vec3 about = Vec3::Zero();
  sum.add(polygon, n, about);
  const int walls = whole ? tips - 1 : tips;  // the last one of all ends at a border's point
  for (int k = 1; k < walls; ++k) {
    const bool last = k + 1 == tips;
    const Vec3 wall[4] = {p.at(tips + k), p.at(last ? leave : tips + k + 1), p.at(last ? k : k + 1),
                          p.at(k)};
    sum.add(wall, last ? 3 : 4, about);
  }
  OverlapMoments m;
  sum.add_to(m);
  if (!(m.volume > 0)) return false;
  double area = 0, least = 0;
  for (int k = 2; k < n; ++k) {
    const Vec3 u = polygon[k - 1] - polygon[0], w = polygon[k] - polygon[0];
    area += (u.x() * w.y() - u.y() * w.x()) / 2;
  }
  for (int k = 0; k < tips; ++k) least = std::min(least, p.z[k]);
  const double inverse = 1 / m.volume;
  out.shape.volume = m.volume;
  out.shape.centroid = inverse * m.first;
  out.shape.second_moment = m.second - inverse * m.first * m.first.transpose();
  out.shape.area = Vec3(0, 0, area);
  out.shape.depth = top - least;
  out.corners = n;
  std::copy(polygon, polygon + n, out.corner);
  out.frame.axes = axes;
  out.frame.origin = own.pose.x + axes * tip;
  return true;
}

// Which corners of the outer face lie below the other's, as bits.
unsigned corners_below(const Part& own, const Part& other) {
  const Vec3& n = other.world_normal;
  const Vec3 m = own.pose.R.transpose() * n;
  const double from =
      own.on.height * n.dot(own.world_normal) + n.dot(own.pose.x - other.pose.x) - other.offset();
  const double* c = own.corner;
  const Eight h = fma(
      Eight(m.x()), Eight::load(c),
      fma(Eight(m.y()), Eight::load(c + 8), fma(Eight(m.z()), Eight::load(c + 16), Eight(from))));
  return less(h, Eight(0.0)) & ((1u << own.corners) - 1);
}

}  // namespace

FlatOverlap flat_cap(const ConvexView& a, const Mat3& Ra, const FlatFace& on_a, const ConvexView& b,
                     const Pose& pose, const FlatFace& on_b, SimpleContact& c) {
  const Part of_a(a, {Ra, Vec3::Zero()}, on_a), of_b(b, pose, on_b);
  if (!of_a.suits() || !of_b.suits() || !(of_a.world_normal.dot(of_b.world_normal) < 0))
    return FlatOverlap::unsure;
  // All of a prism lies above its outer face, seen along the other's normal.
  const unsigned none = 0, of_a_below = on_a.height > 0 ? corners_below(of_a, of_b) : ~none,
                 of_b_below = on_b.height > 0 ? corners_below(of_b, of_a) : ~none;
  if (of_a_below == 0 || of_b_below == 0) return FlatOverlap::nothing;
  c.of_a = false;  // the face's body
  if (on_a.height > 0 && cap_in_face(of_a, of_a_below, of_b, c)) {
    c.shape.area.z() = -c.shape.area.z();  // that of a's faces
    return FlatOverlap::found;
  }
  c.of_a = true;
  if (on_b.height > 0 && cap_in_face(of_b, of_b_below, of_a, c)) return FlatOverlap::found;
  return FlatOverlap::unsure;
}

}  // namespace trackbed::dem
