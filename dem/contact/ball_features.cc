#include "dem/contact/ball_features.h"

#include <algorithm>
#include <cmath>

namespace trackbed::dem {
namespace {

constexpr int kMostRounds = 12;
constexpr double kUphill = -1e-14;  // slopes above this are rounding
constexpr double kSettled = 1e-14;  // of the distance; the next round would gain five digits more

Vec3 vertex(const ConvexView& v, int i) { return {v.x[i], v.y[i], v.z[i]}; }
Vec3 normal(const ConvexView& v, int f) { return {v.nx[f], v.ny[f], v.nz[f]}; }

double radius_at(const PartView& p, const Vec3& x) {
  return p.radius + p.crown / 2 * (p.mean_square - x.squaredNorm());
}

// Everything about one body in its own frame; `slope` is that of |y-x| - r_a - r_b at the point.

bool vertex_is_best(const ConvexView& v, int i, const Vec3& slope) {
  const Star star(v, i);
  const double *ex = star.x(), *ey = star.y(), *ez = star.z();
  const double least = kUphill * v.radius;
  bool best = star.edges() > 0;
  for (int k = 0; k < star.edges(); ++k)
    best &= slope.x() * ex[k] + slope.y() * ey[k] + slope.z() * ez[k] >= least;
  return best;
}

struct Edge {
  Vec3 from, unit;
  double length;
  int left, right;

  Edge(const ConvexView& v, const CoreFeature& f) {
    const Star star(v, f.index);
    from = Vec3(star.at[0], star.at[1], star.at[2]);
    const Vec3 e(star.x()[f.edge], star.y()[f.edge], star.z()[f.edge]);
    length = e.norm();
    unit = e / length;
    left = star.left_face(f.edge), right = star.right_face(f.edge);
  }
  bool holds(double s) const { return s >= 0 && s <= length; }
  /// Into neither face it goes downhill.
  bool is_best(const ConvexView& v, const Vec3& slope) const {
    const Vec3 turned = unit.cross(slope);  // slope . (n x unit) = n . (unit x slope)
    return normal(v, left).dot(turned) >= kUphill && normal(v, right).dot(turned) <= -kUphill;
  }
};

bool within_face(const ConvexView& v, int f, const Vec3& n, const Vec3& p) {
  const int first = v.loop_begin[f], count = v.loop_begin[f + 1] - first;
  Vec3 from = vertex(v, v.loop[first + count - 1]);
  bool inside = true;
  for (int k = 0; k < count; ++k) {
    const Vec3 to = vertex(v, v.loop[first + k]);
    inside &= (to - from).cross(n).dot(p - from) <= 0;
    from = to;
  }
  return inside;
}

// d of d^2 = h^2 + w^2 q^2, w = e/(1+e), e = crown d; w too. False when that does not settle.
bool crowned_distance(double h, double q2, double crown, double& d, double& w) {
  d = h;
  w = 0;
  if (crown == 0) return true;
  for (int k = 0; k < kMostRounds; ++k) {
    const double e = crown * d, was = d;
    w = e / (1 + e);
    d = std::sqrt(h * h + w * w * q2);
    if (std::abs(d - was) <= kSettled * d) return true;
  }
  return false;
}

// From p, a point outside of body v, to the feature of it: `y` there and `way` = y - p.
bool nearest_on(const PartView& part, const CoreFeature& f, const Vec3& p, double apart, Vec3& y,
                Vec3& way, double& d) {
  const ConvexView& v = part.core;
  double w;
  if (f.dimension == 2) {
    const Vec3 n = normal(v, f.index);
    const double h = n.dot(p) - v.offset[f.index];
    if (!(h > apart)) return false;
    const Vec3 q = p - n.dot(p) * n;  // foot of p from that of the centre
    if (!crowned_distance(h, q.squaredNorm(), part.crown, d, w)) return false;
    way = -h * n - w * q;
    y = p + way;
    return within_face(v, f.index, n, y);
  }
  if (f.dimension == 1) {
    const Edge edge(v, f);
    const Vec3 to = p - edge.from;
    const double s = edge.unit.dot(to), q = s + edge.unit.dot(edge.from);
    const Vec3 across = to - s * edge.unit;
    if (!crowned_distance(across.norm(), q * q, part.crown, d, w)) return false;
    if (!(d > apart) || !edge.holds(s - w * q)) return false;
    way = -across - w * q * edge.unit;
    y = p + way;
    return edge.is_best(v, way / d + part.crown * y);
  }
  y = vertex(v, f.index);
  way = y - p;
  d = way.norm();
  return d > apart && vertex_is_best(v, f.index, way / d + part.crown * y);
}

// The balls at x of a and y of b, each in its body's axes, d apart.
void take_radii(const PartView& a, const Vec3& x, const PartView& b, const Vec3& y, double d,
                DeepestBalls& out) {
  out.ra = radius_at(a, x);
  out.rb = radius_at(b, y);
  out.overlap = out.ra + out.rb - d;
}

// A vertex of `own` and any feature of `other`; `apart` is other's centre from own's. World axes:
// x of own about its centre, y of other about own's centre.
bool from_vertex(const PartView& own, const Mat3& R, int i, const PartView& other, const Mat3& S,
                 const Vec3& apart, const CoreFeature& f, double least, DeepestBalls& out) {
  const Vec3 at = vertex(own.core, i);
  out.x = R * at;
  Vec3 y, way;
  double d;
  if (!nearest_on(other, f, S.transpose() * (out.x - apart), least, y, way, d)) return false;
  out.n = S * (way / d);
  if (!vertex_is_best(own.core, i, own.crown * at - R.transpose() * out.n)) return false;
  out.y = out.x + d * out.n;
  take_radii(own, at, other, y, d, out);
  return true;
}

bool edge_on_edge(const PartView& a, const Mat3& Ra, const PartView& b, const Pose& pose,
                  const CoreFeature& on_a, const CoreFeature& on_b, double least,
                  DeepestBalls& out) {
  const Edge ea(a.core, on_a), eb(b.core, on_b);
  const Vec3 ua = Ra * ea.unit, ub = pose.R * eb.unit;
  const Vec3 from_a = Ra * ea.from, from_b = pose.x + pose.R * eb.from, across = from_b - from_a;
  const double cosine = ua.dot(ub), fa = across.dot(ua), fb = -across.dot(ub);
  const double qa = ea.unit.dot(ea.from), qb = eb.unit.dot(eb.from);
  double d = a.radius + b.radius, s = 0, t = 0;
  for (int k = 0;; ++k) {
    if (k == kMostRounds) return false;
    const double wa = a.crown * d, wb = b.crown * d, was = d;
    const double det = (1 + wa) * (1 + wb) - cosine * cosine;
    if (!(det > 1e-8)) return false;
    const double f = fa - wa * qa, g = fb - wb * qb;
    s = (f * (1 + wb) + cosine * g) / det;
    t = (g * (1 + wa) + cosine * f) / det;
    out.n = across + t * ub - s * ua;
    d = out.n.norm();
    if (std::abs(d - was) <= kSettled * d || (wa == 0 && wb == 0)) break;
  }
  if (!(d > least) || !ea.holds(s) || !eb.holds(t)) return false;
  out.n /= d;
  const Vec3 x = ea.from + s * ea.unit, y = eb.from + t * eb.unit;
  if (!ea.is_best(a.core, a.crown * x - Ra.transpose() * out.n) ||
      !eb.is_best(b.core, b.crown * y + pose.R.transpose() * out.n))
    return false;
  out.x = from_a + s * ua;
  out.y = out.x + d * out.n;
  take_radii(a, x, b, y, d, out);
  return true;
}

// An edge or a face of `own` and a face of `other`, as from_vertex. For given d, y is the foot of x
// drawn to other's centre, which leaves h^2/2 + w q^2/2 + e s^2/2 to x, s from the foot of own's
// centre.
bool on_face(const PartView& own, const Mat3& R, const CoreFeature& on_own, const PartView& other,
             const Mat3& S, const Vec3& apart, int face, double least, DeepestBalls& out) {
  const bool line = on_own.dimension == 1;
  const Vec3 own_normal = line ? Vec3(Vec3::Zero()) : normal(own.core, on_own.index);
  Vec3 foot = Vec3::Zero(), along = Vec3::Zero();
  double from = 0, to = 0;
  if (line) {
    const Edge edge(own.core, on_own);
    from = edge.unit.dot(edge.from), to = from + edge.length;
    foot = R * (edge.from - from * edge.unit);
    along = R * edge.unit;
  } else {
    foot = R * (own.core.offset[on_own.index] * own_normal);
    along = R * own_normal;
  }
  const Vec3 body_normal = normal(other.core, face), n = S * body_normal;
  const double offset = other.core.offset[face];
  const Vec3 r0 = foot - apart;
  const double height = n.dot(r0);
  const Vec3 q0 = r0 - height * n;
  const double cosine = n.dot(along);
  const Vec3 m = line ? Vec3(cosine * along) : Vec3(n - cosine * along);
  const double slope2 = line ? cosine * cosine : m.squaredNorm();

  double d = own.radius + other.radius, h = 0, w = 0;
  Vec3 step, q;
  for (int k = 0;; ++k) {
    if (k == kMostRounds) return false;
    const double e = other.crown * d, own_e = own.crown * d, was = d;
    w = e / (1 + e);
    const Vec3 g = (height - offset) * n + w * q0;
    if (line) {
      const double stiff = slope2 + w * (1 - slope2) + own_e;
      if (!(stiff > 1e-8)) return false;
      step = -(along.dot(g) / stiff) * along;
    } else {
      const double flat = w + own_e;  // (flat 1 + (1-w) m m') step = -g, in own's plane
      if (!(flat > 1e-8)) return false;
      step = along.dot(g) * along - g;
      step = (step - (1 - w) * m.dot(step) / (flat + (1 - w) * slope2) * m) / flat;
      step -= along.dot(step) * along;  // rounding, 1/flat times as large: x stays in its plane
    }
    const double rise = n.dot(step);
    h = height - offset + rise;
    q = q0 + step - rise * n;
    d = std::sqrt(h * h + w * w * q.squaredNorm());
    if (std::abs(d - was) <= kSettled * d) break;
  }
  if (!(h > least)) return false;
  out.x = foot + step;
  out.n = (-h * n - w * q) / d;
  out.y = out.x + d * out.n;
  const Vec3 x = R.transpose() * out.x, y = S.transpose() * (out.y - apart);
  if (!within_face(other.core, face, body_normal, y)) return false;
  if (line) {
    const Edge edge(own.core, on_own);
    const double s = edge.unit.dot(x);
    if (!(s >= from && s <= to) || !edge.is_best(own.core, own.crown * x - R.transpose() * out.n))
      return false;
  } else if (!(along.dot(out.n) > 0) || !within_face(own.core, on_own.index, own_normal, x)) {
    return false;  // else x might be the farthest point of the back
  }
  take_radii(own, x, other, y, d, out);
  return true;
}

// The feature of `own` has not more dimensions than that of `other`.
bool again(const PartView& own, const Mat3& R, const CoreFeature& on_own, const PartView& other,
           const Mat3& S, const Vec3& apart, const CoreFeature& on_other, DeepestBalls& out) {
  const double least = least_distance(own, other);
  if (on_own.dimension == 0)
    return from_vertex(own, R, on_own.index, other, S, apart, on_other, least, out);
  if (on_other.dimension == 1)
    return edge_on_edge(own, R, other, {S, apart}, on_own, on_other, least, out);
  return on_face(own, R, on_own, other, S, apart, on_other.index, least, out);
}

// Vertices of many edges have no star (ConvexView).
bool known(const ConvexView& v, const CoreFeature& f) {
  return f.dimension == 0 || f.dimension == 2 ||
         (f.dimension == 1 && f.edge < Star(v, f.index).edges());
}

}  // namespace

CoreFeature feature_of(const ConvexView& v, const ClosestPoint& at, const Vec3& point) {
  if (!v.stars || at.dimension > 2) return {};
  if (at.dimension == 2) return {2, at.face, 0};
  const int first = v.loop_begin[at.face], count = v.loop_begin[at.face + 1] - first;
  int from = v.loop[first];
  if (at.dimension == 1) {
    from = v.loop[first + at.edge];
    const int to = v.loop[first + (at.edge + 1) % count];
    for (int k = v.neighbor_begin[from]; k < v.neighbor_begin[from + 1]; ++k)
      if (v.neighbor[k] == to) return {1, from, k - v.neighbor_begin[from]};
    return {};
  }
  for (int k = 1; k < count; ++k) {
    const int i = v.loop[first + k];
    if ((vertex(v, i) - point).squaredNorm() < (vertex(v, from) - point).squaredNorm()) from = i;
  }
  return {0, from, 0};
}

bool deepest_balls_again(const PartView& a, const Mat3& Ra, const PartView& b, const Pose& pose,
                         const CoreFeature& on_a, const CoreFeature& on_b, DeepestBalls& out) {
  if (!known(a.core, on_a) || !known(b.core, on_b)) return false;
  if (on_a.dimension <= on_b.dimension) return again(a, Ra, on_a, b, pose.R, pose.x, on_b, out);
  if (!again(b, pose.R, on_b, a, Ra, -pose.x, on_a, out)) return false;
  // The other way round, about a's centre.
  const Vec3 x = out.y + pose.x;
  out.y = out.x + pose.x;
  out.x = x;
  out.n = -out.n;
  std::swap(out.ra, out.rb);
  return true;
}

}  // namespace trackbed::dem
