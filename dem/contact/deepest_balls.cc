#include "dem/contact/deepest_balls.h"

#include <algorithm>
#include <cmath>

#include "dem/contact/ball_features.h"

namespace trackbed::dem {
namespace {

constexpr int kMostRounds = 60;

double radius_at(const PartView& p, const Vec3& x) {
  return p.radius + p.crown / 2 * (p.mean_square - x.squaredNorm());
}

// Minimises |x-y|^2/2 + ea |x|^2/2 + eb |y-c|^2/2 over the lines or planes on which x and y lie (c
// the centre of b). Frame of a.
struct Feature {
  int dimension;
  Vec3 along;  // of an edge; normal of a face
  Vec3 project(const Vec3& v) const {
    if (dimension == 0) return Vec3::Zero();
    const Vec3 part = along.dot(v) * along;
    return dimension == 1 ? part : Vec3(v - part);
  }
};

void solve_on_features(const Feature& fa, const Feature& fb, double ea, double eb, const Vec3& c,
                       Vec3& x, Vec3& y) {
  Vec3 t[2];
  int size = 1;
  t[0] = fa.along;
  if (fa.dimension == 2) {
    size = 2;
    t[0] = fa.along.unitOrthogonal();
    t[1] = fa.along.cross(t[0]);
  }
  const Vec3 x0 = x, y0 = y;
  const double sb = 1 / (1 + eb);
  const auto best_y = [&](const Vec3& at) -> Vec3 {
    return y0 + fb.project(sb * (at + eb * c) - y0);
  };
  const Vec3 slope = x0 - best_y(x0) + ea * x0;
  Vec3 q[2];
  for (int k = 0; k < size; ++k) q[k] = (1 + ea) * t[k] - sb * fb.project(t[k]);
  double u[2] = {0, 0};
  const double a = t[0].dot(q[0]), f = -t[0].dot(slope);
  if (size == 1) {
    if (a > 0) u[0] = f / a;
  } else {
    const double b = t[0].dot(q[1]), d = t[1].dot(q[1]), g = -t[1].dot(slope);
    const double det = a * d - b * b;
    if (det > 0) u[0] = (f * d - g * b) / det, u[1] = (g * a - f * b) / det;
  }
  x = x0 + u[0] * t[0];
  if (size == 2) x += u[1] * t[1];
  y = best_y(x);
}

// How much of the way from p to q stays on the feature of `at`; `stop`: what it ends at, an edge of
// a face or (any value) the end of an edge.
double share_inside(const ConvexView& v, const ClosestPoint& at, const Vec3& p, const Vec3& q,
                    int& stop) {
  const int first = v.loop_begin[at.face], count = v.loop_begin[at.face + 1] - first;
  const auto corner = [&](int k) {
    const int i = v.loop[first + k % count];
    return Vec3(v.x[i], v.y[i], v.z[i]);
  };
  const Vec3 d = q - p;
  double share = 1;
  if (at.dimension == 1) {
    const Vec3 from = corner(at.edge), to = corner(at.edge + 1);
    const double here = at.along.dot(p - from), way = at.along.dot(d), l = at.along.dot(to - from);
    if (here + way > l) share = (l - here) / way;
    if (here + way < 0) share = -here / way;
    return std::clamp(share, 0., 1.);
  }
  Vec3 from = corner(count - 1);
  for (int k = 0; k < count; ++k) {
    const Vec3 to = corner(k), out = (to - from).cross(at.along);
    const double here = out.dot(p - from), way = out.dot(d);
    if (way > 0 && here + way > 0) {
      const double s = std::max(0., -here / way);
      if (s < share) share = s, stop = k == 0 ? count - 1 : k - 1;
    }
    from = to;
  }
  return share;
}

// The feature that the way ended at: an edge of the face, or the edge's end.
void narrow(const ConvexView& v, int stop, ClosestPoint& at) {
  if (--at.dimension == 0) return;
  const int first = v.loop_begin[at.face], count = v.loop_begin[at.face + 1] - first;
  const int i = v.loop[first + stop], j = v.loop[first + (stop + 1) % count];
  at.edge = stop;
  at.along = Vec3(v.x[j] - v.x[i], v.y[j] - v.y[i], v.z[j] - v.z[i]).normalized();
}

Vec3 top(const ConvexView& v, const Vec3& n) {
  Vec3 best = Vec3::Zero();
  double most = -HUGE_VAL;
  for (int k = 0; k < v.vertices; ++k) {
    const Vec3 p(v.x[k], v.y[k], v.z[k]);
    if (p.dot(n) > most) most = p.dot(n), best = p;
  }
  return best;
}

// Nearest to p drawn to the centre by the crown, `distance` about p's from the core. Where that is
// too large p may be drawn inside from outside: then nearest to p itself.
ClosestPoint closest_drawn(const PartView& part, const Vec3& p, double distance) {
  const double e = part.crown * distance;
  const ClosestPoint c = closest_point(part.core, p / (1 + e));
  return c.dimension == 3 && e > 0 ? closest_point(part.core, p) : c;
}

// Along the axis of least depth, once cores overlap; the contact point, half way between the balls'
// surfaces, stays at `start` if the pair has touched before.
DeepestBalls deep(const PartView& a, const Mat3& Ra, const PartView& b, const Pose& pose,
                  const Vec3& start, Vec3& axis) {
  const double gap = separating_axis(a.core, {Ra, Vec3::Zero()}, b.core, pose, axis);
  DeepestBalls d;
  d.n = axis.normalized();
  const bool fresh = start == Vec3::Zero();
  Vec3 middle = start - (a.radius - b.radius) / 2 * d.n;  // of x and y
  if (fresh)
    middle = (Ra * top(a.core, Ra.transpose() * d.n) + pose.x +
              pose.R * top(b.core, -(pose.R.transpose() * d.n))) /
             2;
  d.ra = radius_at(a, closest_point(a.core, Ra.transpose() * middle).point);
  d.rb = radius_at(b, closest_point(b.core, pose.R.transpose() * (middle - pose.x)).point);
  if (!fresh) middle = start - (d.ra - d.rb) / 2 * d.n;
  d.x = middle - gap / 2 * d.n;
  d.y = middle + gap / 2 * d.n;
  d.overlap = d.ra + d.rb - gap;
  return d;
}

}  // namespace

DeepestBalls deepest_balls(const Vec3& centre, double r, const PartView& b, const Pose& pose,
                           int& face) {
  DeepestBalls d;
  d.x = centre;
  d.ra = r;
  const Vec3 p = pose.R.transpose() * (centre - pose.x);
  ClosestPoint c = closest_point(b.core, p, face - 1);
  if (b.crown > 0)  // towards the centre of b by the crown
    for (int k = 0; k < 8 && c.dimension != 3; ++k) {
      const Vec3 was = c.point;
      const double e = b.crown * (p - c.point).norm();
      c = closest_point(b.core, p / (1 + e), c.face);
      if ((c.point - was).squaredNorm() <= 1e-24 * p.squaredNorm()) break;
    }
  face = c.dimension == 2 ? c.face + 1 : 0;
  d.rb = radius_at(b, c.point);
  if (c.dimension == 3) {
    const Vec3 normal = pose.R * c.along;
    const double depth = c.along.dot(c.point - p);
    d.n = -normal;
    d.y = centre + depth * normal;
    d.overlap = r + d.rb + depth;
    return d;
  }
  const Vec3 way = pose.R * (c.point - p);
  const double distance = way.norm();
  if (c.dimension == 2 && b.crown == 0)
    d.n = -(pose.R * c.along);
  else
    d.n = way / distance;
  d.y = centre + way;
  d.overlap = r + d.rb - distance;
  return d;
}

DeepestBalls deepest_balls(const PartView& a, const Mat3& Ra, const PartView& b, const Pose& pose,
                           const Vec3& start, Vec3& axis) {
  // Everything in the frame of a; b's points are found in its own.
  const Mat3 R = Ra.transpose() * pose.R;
  const Vec3 centre = Ra.transpose() * pose.x;
  const double tolerance2 = 1e-24 * (a.core.radius * a.core.radius + a.radius * a.radius);
  const double least = least_distance(a, b);
  const bool fresh = start == Vec3::Zero();
  Vec3 x = closest_point(a.core, fresh ? centre : Vec3(Ra.transpose() * start)).point, y;
  double distance = fresh ? 0 : a.radius + b.radius;  // about what it is in a contact
  ClosestPoint ca, cb;
  Vec3 was = Vec3::Constant(HUGE_VAL);
  for (int round = 0; round < kMostRounds; ++round) {
    cb = closest_drawn(b, R.transpose() * (x - centre), distance);
    if (cb.dimension == 3) return deep(a, Ra, b, pose, start, axis);
    y = centre + R * cb.point;
    const double before = distance;
    distance = (y - x).norm();
    ca = closest_drawn(a, y, distance);
    if (ca.dimension == 3 || !(distance > least)) return deep(a, Ra, b, pose, start, axis);
    x = ca.point;
    distance = (y - x).norm();
    if (round == 0) {
      DeepestBalls walked;
      if (walk_to_deepest_balls(a, Ra, b, pose, feature_of(a.core, ca, x), x,
                                feature_of(b.core, cb, cb.point), cb.point, walked))
        return walked;
    }
    const bool settled = std::abs(distance - before) <= 1e-11 * distance;
    if (settled && (x - was).squaredNorm() <= tolerance2) break;
    while (ca.dimension > 0 && cb.dimension > 0) {
      Vec3 xs = x, ys = y;
      const Feature fb{cb.dimension, R * cb.along};
      solve_on_features({ca.dimension, ca.along}, fb, a.crown * distance, b.crown * distance,
                        centre, xs, ys);
      int stop_a = 0, stop_b = 0;
      const double share_a = share_inside(a.core, ca, x, xs, stop_a);
      const double share_b = share_inside(b.core, cb, R.transpose() * (y - centre),
                                          R.transpose() * (ys - centre), stop_b);
      const double share = std::min(share_a, share_b);
      x += share * (xs - x);
      y += share * (ys - y);
      if (share == 1) break;
      if (share_a <= share_b)
        narrow(a.core, stop_a, ca);
      else
        narrow(b.core, stop_b, cb);
    }
    was = x;
  }
  if (!((y - x).norm() > least)) return deep(a, Ra, b, pose, start, axis);
  DeepestBalls d;
  d.x = Ra * x;
  d.y = Ra * y;
  d.n = (d.y - d.x) / (d.y - d.x).norm();
  d.ra = radius_at(a, x);
  d.rb = radius_at(b, R.transpose() * (y - centre));
  d.overlap = d.ra + d.rb - (d.y - d.x).norm();
  d.on_a = feature_of(a.core, ca, x).code();
  d.on_b = feature_of(b.core, cb, R.transpose() * (y - centre)).code();
  return d;
}

}  // namespace trackbed::dem
