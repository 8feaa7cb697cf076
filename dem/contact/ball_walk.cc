// An active-set search of deepest_balls.h' convex problem over vertices, edges and faces.
#include <cmath>

#include "dem/contact/ball_features.h"

namespace trackbed::dem {
namespace {

constexpr int kMostSteps = 100;
constexpr double kDownhill = -1e-15;

Vec3 vertex(const ConvexView& v, int i) { return {v.x[i], v.y[i], v.z[i]}; }
Vec3 normal(const ConvexView& v, int f) { return {v.nx[f], v.ny[f], v.nz[f]}; }
Vec3 edge(const ConvexView& v, const CoreFeature& f) {
  return vertex(v, v.neighbor[v.neighbor_begin[f.index] + f.edge]) - vertex(v, f.index);
}

// The edge between two vertices, seen from the first.
CoreFeature edge_between(const ConvexView& v, int from, int to) {
  for (int k = v.neighbor_begin[from]; k < v.neighbor_begin[from + 1]; ++k)
    if (v.neighbor[k] == to) return {1, from, k - v.neighbor_begin[from]};
  return {};
}
// The face left of a vertex's edge, and right of it.
int left_face(const ConvexView& v, int from, int edge) {
  return v.left_face[v.neighbor_begin[from] + edge];
}
int right_face(const ConvexView& v, int from, int edge) {
  const int edges = v.neighbor_begin[from + 1] - v.neighbor_begin[from];
  return left_face(v, from, (edge > 0 ? edge : edges) - 1);
}

// One body of the two, in its own frame.
struct Walker {
  const PartView& part;
  CoreFeature on;
  Vec3 at;

  const ConvexView& core() const { return part.core; }
  Vec3 direction() const {  // of an edge; normal of a face
    if (on.dimension == 1) return edge(core(), on).normalized();
    return on.dimension == 2 ? normal(core(), on.index) : Vec3(Vec3::Zero());
  }

  // How much of the way from `at` to `to` stays on the feature, and what bounds it there.
  double share(const Vec3& to, CoreFeature& bound) const {
    const ConvexView& v = core();
    const Vec3 way = to - at;
    double share = 1;
    if (on.dimension == 1) {
      const Vec3 e = edge(v, on), from = vertex(v, on.index);
      const double l2 = e.squaredNorm(), here = e.dot(at - from), go = e.dot(way);
      if (here + go > l2) {
        share = (l2 - here) / go;
        bound = {0, v.neighbor[v.neighbor_begin[on.index] + on.edge], 0};
      } else if (here + go < 0) {
        share = -here / go;
        bound = {0, on.index, 0};
      }
    } else if (on.dimension == 2) {
      const Vec3 n = normal(v, on.index);
      const int first = v.loop_begin[on.index], count = v.loop_begin[on.index + 1] - first;
      for (int k = 0; k < count; ++k) {
        const int i = v.loop[first + k], j = v.loop[first + (k + 1) % count];
        const Vec3 from = vertex(v, i), out = (vertex(v, j) - from).cross(n);
        const double here = out.dot(at - from), go = out.dot(way);
        if (!(go > 0 && here + go > 0)) continue;
        const double s = -here / go;
        if (s < share) share = s, bound = edge_between(v, i, j);
      }
    }
    return std::max(share, 0.0);
  }

  // The larger feature at `at` that goes downhill most steeply: that slope, 0 if none does.
  double downhill(const Vec3& slope, CoreFeature& larger) const {
    const ConvexView& v = core();
    double best = kDownhill;
    const auto try_out = [&](const Vec3& way, const CoreFeature& f) {
      const double s = slope.dot(way) / way.norm();
      if (s < best) best = s, larger = f;
    };
    if (on.dimension == 0) {
      const int edges = v.neighbor_begin[on.index + 1] - v.neighbor_begin[on.index];
      for (int k = 0; k < edges; ++k) try_out(edge(v, {1, on.index, k}), {1, on.index, k});
    } else if (on.dimension == 1) {
      const Vec3 e = edge(v, on);
      const int left = left_face(v, on.index, on.edge), right = right_face(v, on.index, on.edge);
      try_out(normal(v, left).cross(e), {2, left, 0});
      try_out(e.cross(normal(v, right)), {2, right, 0});
    }
    return best < kDownhill ? best : 0;
  }
};

Vec3 onto(int dimension, const Vec3& along, const Vec3& v) {
  if (dimension == 0) return Vec3::Zero();
  const Vec3 part = along.dot(v) * along;
  return dimension == 1 ? part : Vec3(v - part);
}

// Minimises |x-y|^2/2 + ea |x|^2/2 + eb |y-c|^2/2 over the points, lines or planes on which x and y
// lie (c the centre of b), from x and y. Frame of a.
void solve(int dim_a, const Vec3& along_a, int dim_b, const Vec3& along_b, double ea, double eb,
           const Vec3& c, Vec3& x, Vec3& y) {
  const Vec3 y0 = y;
  const double sb = 1 / (1 + eb);
  const auto best_y = [&](const Vec3& at) -> Vec3 {
    return y0 + onto(dim_b, along_b, sb * (at + eb * c) - y0);
  };
  if (dim_a > 0) {
    Vec3 t[2] = {along_a, Vec3::Zero()};
    if (dim_a == 2) t[0] = along_a.unitOrthogonal(), t[1] = along_a.cross(t[0]);
    const Vec3 slope = (1 + ea) * x - best_y(x);
    Vec3 q[2];
    for (int k = 0; k < dim_a; ++k) q[k] = (1 + ea) * t[k] - sb * onto(dim_b, along_b, t[k]);
    const double m = t[0].dot(q[0]), f = -t[0].dot(slope);
    if (dim_a == 1) {
      if (m > 0) x += f / m * t[0];
    } else {
      const double o = t[0].dot(q[1]), d = t[1].dot(q[1]), g = -t[1].dot(slope);
      const double det = m * d - o * o;
      if (det > 0) x += (f * d - g * o) / det * t[0] + (g * m - f * o) / det * t[1];
    }
  }
  y = best_y(x);
}

}  // namespace

bool walk_to_deepest_balls(const PartView& a, const Mat3& Ra, const PartView& b, const Pose& pose,
                           CoreFeature on_a, const Vec3& x, CoreFeature on_b, const Vec3& y,
                           DeepestBalls& out) {
  if (!a.core.stars || !b.core.stars || on_a.dimension < 0 || on_b.dimension < 0) return false;
  const Mat3 R = Ra.transpose() * pose.R;
  const Vec3 c = Ra.transpose() * pose.x;
  Walker wa{a, on_a, x}, wb{b, on_b, y};
  for (int step = 0; step < kMostSteps; ++step) {
    if (deepest_balls_again(a, Ra, b, pose, wa.on, wb.on, out)) {
      out.on_a = wa.on.code(), out.on_b = wb.on.code();
      return true;
    }
    Vec3 xs = wa.at, ys = c + R * wb.at;
    const Vec3 along_a = wa.direction(), along_b = R * wb.direction();
    for (int k = 0; k < 3; ++k) {
      const double d = (ys - xs).norm();
      solve(wa.on.dimension, along_a, wb.on.dimension, along_b, a.crown * d, b.crown * d, c, xs,
            ys);
    }
    const Vec3 to_b = R.transpose() * (ys - c);
    CoreFeature bound_a, bound_b;
    const double share_a = wa.share(xs, bound_a), share_b = wb.share(to_b, bound_b);
    const double share = std::min(share_a, share_b);
    wa.at += share * (xs - wa.at);
    wb.at += share * (to_b - wb.at);
    if (share < 1) {
      (share_a <= share_b ? wa.on : wb.on) = share_a <= share_b ? bound_a : bound_b;
      continue;
    }
    const Vec3 way = c + R * wb.at - wa.at;
    const double d = way.norm();
    if (!(d > 0)) return false;
    CoreFeature larger_a, larger_b;
    const double down_a = wa.downhill(a.crown * wa.at - way / d, larger_a),
                 down_b = wb.downhill(b.crown * wb.at + R.transpose() * way / d, larger_b);
    if (down_a == 0 && down_b == 0) return false;
    if (down_a <= down_b)
      wa.on = larger_a;
    else
      wb.on = larger_b;
  }
  return false;
}

}  // namespace trackbed::dem
