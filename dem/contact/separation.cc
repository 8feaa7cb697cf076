#include "dem/contact/separation.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "dem/contact/eight.h"

namespace trackbed::dem {
namespace {

// Largest n.p over the vertices, n in body axes.
double top(const ConvexView& v, const Vec3& n) {
  const Eight nx(n.x()), ny(n.y()), nz(n.z());
  Eight best(-std::numeric_limits<double>::infinity());
  int i = 0;
  for (; i + 8 <= v.padded; i += 8)
    best = max(best, fma(nx, Eight::load(v.x + i),
                         fma(ny, Eight::load(v.y + i), nz * Eight::load(v.z + i))));
  double most = largest(best);
  for (; i < v.vertices; ++i)
    most = std::max(most, n.x() * v.x[i] + n.y() * v.y[i] + n.z() * v.z[i]);
  return most;
}

// The face whose normal is nearest to n (body axes) if its cosine exceeds `nearest`, else -1.
int nearest_face(const ConvexView& v, const Vec3& n, double& nearest) {
  if (v.planes_padded) {  // most often none is near
    const Eight nx(n.x()), ny(n.y()), nz(n.z());
    Eight best(-1.0);
    for (int f = 0; f < v.faces; f += 8)
      best = max(best, fma(nx, Eight::load(v.nx + f),
                           fma(ny, Eight::load(v.ny + f), nz * Eight::load(v.nz + f))));
    if (!(largest(best) > nearest)) return -1;
  }
  int face = -1;
  for (int f = 0; f < v.faces; ++f) {
    const double c = n.x() * v.nx[f] + n.y() * v.ny[f] + n.z() * v.nz[f];
    if (c > nearest) nearest = c, face = f;
  }
  return face;
}

int top_vertex(const ConvexView& v, const Vec3& n) {
  int k = 0;
  double best = -std::numeric_limits<double>::infinity();
  for (int i = 0; i < v.vertices; ++i) {
    const double d = n.x() * v.x[i] + n.y() * v.y[i] + n.z() * v.z[i];
    if (d > best) best = d, k = i;
  }
  return k;
}

Vec3 vertex(const ConvexView& v, int i) { return {v.x[i], v.y[i], v.z[i]}; }

// Closest point to the origin of a simplex of 1..4 points; drops the points it does not need.
// Region tests after Ericson, Real-Time Collision Detection (2005), 5.1.
struct Simplex {
  Vec3 p[4] = {Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  int n = 0;

  Vec3 segment(Vec3 a, Vec3 b) {  // by value: they may be own corners
    const Vec3 ab = b - a;
    const double t = -a.dot(ab), l = ab.squaredNorm();
    if (t <= 0 || !(l > 0)) return keep(a);
    if (t >= l) return keep(b);
    p[0] = a, p[1] = b, n = 2;
    return a + (t / l) * ab;
  }
  Vec3 triangle(Vec3 a, Vec3 b, Vec3 c) {
    const Vec3 ab = b - a, ac = c - a;
    const double d1 = -ab.dot(a), d2 = -ac.dot(a), d3 = -ab.dot(b), d4 = -ac.dot(b),
                 d5 = -ab.dot(c), d6 = -ac.dot(c);
    if (d1 <= 0 && d2 <= 0) return keep(a);
    if (d3 >= 0 && d4 <= d3) return keep(b);
    if (d6 >= 0 && d5 <= d6) return keep(c);
    const double vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return segment(a, b);
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return segment(a, c);
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return segment(b, c);
    const Vec3 normal = ab.cross(ac);
    const double l = normal.squaredNorm();
    if (!(l > 0)) return segment(a, b);
    p[0] = a, p[1] = b, p[2] = c, n = 3;
    return (normal.dot(a) / l) * normal;
  }
  // False when the origin is inside.
  bool tetrahedron(Vec3& closest) {
    const Vec3 q[4] = {p[0], p[1], p[2], p[3]};
    static constexpr int side[4][4] = {{0, 1, 2, 3}, {0, 1, 3, 2}, {0, 2, 3, 1}, {1, 2, 3, 0}};
    double best = std::numeric_limits<double>::infinity();
    Simplex nearest;
    bool outside = false;
    for (const auto& s : side) {
      const Vec3 normal = (q[s[1]] - q[s[0]]).cross(q[s[2]] - q[s[0]]);
      const double origin = -normal.dot(q[s[0]]), fourth = normal.dot(q[s[3]] - q[s[0]]);
      if (origin * fourth > 0) continue;
      outside = true;
      Simplex t;
      const Vec3 c = t.triangle(q[s[0]], q[s[1]], q[s[2]]);
      if (c.squaredNorm() < best) best = c.squaredNorm(), nearest = t, closest = c;
    }
    if (outside) *this = nearest;
    return outside;
  }
  bool closest(Vec3& c) {
    if (n == 1) return c = p[0], true;
    if (n == 2) return c = segment(p[0], p[1]), true;
    if (n == 3) return c = triangle(p[0], p[1], p[2]), true;
    return tetrahedron(c);
  }

 private:
  Vec3 keep(Vec3 a) {
    p[0] = a, n = 1;
    return a;
  }
};

Vec3 unit_or(const Vec3& v, const Vec3& other) {
  const double largest = v.cwiseAbs().maxCoeff();
  if (!(largest > 0) || !std::isfinite(largest)) return other;
  return (v / largest).normalized();
}

struct Pair {
  const ConvexView &a, &b;
  const Pose &pa, &pb;
  Vec3 ab;  // x_b - x_a

  double gap(const Vec3& n) const {
    const Vec3 na = pa.R.transpose() * n, nb = pb.R.transpose() * n;
    return n.dot(ab) - top(b, -nb) - top(a, na);
  }
  // The point of b - a that lies lowest along n.
  Vec3 support(const Vec3& n) const {
    const int i = top_vertex(a, pa.R.transpose() * n), k = top_vertex(b, -(pb.R.transpose() * n));
    return ab + pb.R * vertex(b, k) - pa.R * vertex(a, i);
  }
};

// While they overlap: the face normal of least depth is a good axis.
void best_face(const Pair& pair, double& best, Vec3& axis) {
  for (int f = 0; f < pair.a.faces; ++f) {
    const Vec3 n = pair.pa.R * Vec3(pair.a.nx[f], pair.a.ny[f], pair.a.nz[f]);
    const double g = pair.gap(n);
    if (g > best) best = g, axis = n;
  }
  for (int f = 0; f < pair.b.faces; ++f) {
    const Vec3 n = -(pair.pb.R * Vec3(pair.b.nx[f], pair.b.ny[f], pair.b.nz[f]));
    const double g = pair.gap(n);
    if (g > best) best = g, axis = n;
  }
}

// Gilbert-Johnson-Keerthi from `axis`: improves axis and its gap `best` until the bodies are apart
// along it by at least 0.8 of their distance (an axis close to the widest gap lasts longest), or
// until they are known to overlap.
void widen(const Pair& pair, double& best, Vec3& axis) {
  const double noise = 1e-14 * (pair.a.radius + pair.b.radius);
  Simplex simplex;
  simplex.p[simplex.n++] = pair.support(axis);
  for (int iteration = 0; iteration < 32; ++iteration) {
    Vec3 closest;
    if (!simplex.closest(closest)) return;
    const double distance = closest.norm();
    if (!(distance > noise)) return;
    const Vec3 n = closest / distance;
    const double g = pair.gap(n);
    if (g > best) best = g, axis = n;
    if (best >= 0.8 * distance) return;
    const Vec3 w = pair.support(n);
    for (int k = 0; k < simplex.n; ++k)
      if (w == simplex.p[k]) return;
    simplex.p[simplex.n++] = w;
  }
}

// While they overlap: the direction between the closest points once b is pushed out along the best
// axis so far is a better one (edge on edge is found this way).
void push_out(const Pair& pair, double& best, Vec3& axis) {
  for (int round = 0; round < 8; ++round) {
    Pair apart = pair;
    apart.ab -= 1.05 * best * axis;
    Vec3 n = axis;
    double gap = 0;
    widen(apart, gap, n);
    const double g = pair.gap(n);
    if (!(g > best)) return;
    best = g, axis = n;
  }
}

}  // namespace

double support_gap(const ConvexView& a, const Pose& pa, const ConvexView& b, const Pose& pb,
                   const Vec3& n) {
  return Pair{a, b, pa, pb, pb.x - pa.x}.gap(n);
}

double separating_axis(const ConvexView& a, const Pose& pa, const ConvexView& b, const Pose& pb,
                       Vec3& axis) {
  const Pair pair{a, b, pa, pb, pb.x - pa.x};
  axis = unit_or(axis, unit_or(pair.ab, Vec3::UnitZ()));
  double best = pair.gap(axis);
  if (best > 0) return best;

  widen(pair, best, axis);
  if (!(best > 0)) best_face(pair, best, axis);
  if (!(best > 0)) push_out(pair, best, axis);
  return best;
}

ContactFrame contact_frame(const ConvexView& a, const Pose& pa, const ConvexView& b, const Pose& pb,
                           const Vec3& axis) {
  const Vec3 ab = pb.x - pa.x;
  Vec3 n = unit_or(axis, unit_or(ab, Vec3::UnitZ()));

  // A flat overlap lies between two nearly parallel faces: take the nearest face's own normal.
  const Vec3 na = pa.R.transpose() * n, nb = -(pb.R.transpose() * n);
  double nearest = 0.99;
  const int face_a = nearest_face(a, na, nearest), face_b = nearest_face(b, nb, nearest);
  if (face_b >= 0)
    n = -(pb.R * Vec3(b.nx[face_b], b.ny[face_b], b.nz[face_b]));
  else if (face_a >= 0)
    n = pa.R * Vec3(a.nx[face_a], a.ny[face_a], a.nz[face_a]);

  ContactFrame frame;
  frame.axes = axes_along(n);

  // Across the normal: between the bodies, nearer to the smaller one. Along it: mid slab.
  const double share = a.radius / (a.radius + b.radius);
  const double upper = top(a, pa.R.transpose() * n);                 // from x_a
  const double lower = n.dot(ab) - top(b, -(pb.R.transpose() * n));  // from x_a
  const double along = 0.5 * (upper + lower) - share * n.dot(ab);
  frame.origin = pa.x + share * ab + along * n;
  return frame;
}

}  // namespace trackbed::dem
