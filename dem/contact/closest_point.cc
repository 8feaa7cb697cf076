#include "dem/contact/closest_point.h"

#include <cmath>

#include "dem/contact/eight.h"

namespace trackbed::dem {
namespace {

Vec3 vertex(const ConvexView& v, int i) { return {v.x[i], v.y[i], v.z[i]}; }

// Nearest point of face f to p, which lies `height` above its plane; true: within the face.
bool closest_on_face(const ConvexView& v, int f, const Vec3& p, double height, double& best,
                     ClosestPoint& out) {
  const Vec3 n(v.nx[f], v.ny[f], v.nz[f]);
  const int first = v.loop_begin[f], count = v.loop_begin[f + 1] - first;
  bool inside = true;
  Vec3 from = vertex(v, v.loop[first + count - 1]);
  for (int k = 0; k < count; ++k) {
    const Vec3 to = vertex(v, v.loop[first + k]);
    const Vec3 e = to - from, d = p - from;
    if (e.cross(n).dot(d) > 0) {  // beyond this edge
      inside = false;
      const double l2 = e.squaredNorm(), t = e.dot(d);
      const bool at_from = t <= 0, at_to = t >= l2;
      const Vec3 q = at_from ? from : at_to ? to : Vec3(from + (t / l2) * e);
      const double distance2 = (p - q).squaredNorm();
      if (distance2 < best) {
        best = distance2;
        out.point = q;
        out.face = f;
        out.dimension = at_from || at_to ? 0 : 1;
        out.edge = k == 0 ? count - 1 : k - 1;
        if (out.dimension == 1) out.along = e / std::sqrt(l2);
      }
    }
    from = to;
  }
  if (!inside) return false;
  best = height * height;
  out.point = p - height * n;
  out.face = f;
  out.dimension = 2;
  out.along = n;
  return true;
}

// Of p above eight planes from f on.
Eight heights(const ConvexView& v, int f, const Vec3& p) {
  return fma(p.x(), Eight::load(v.nx + f),
             fma(p.y(), Eight::load(v.ny + f), p.z() * Eight::load(v.nz + f))) -
         Eight::load(v.offset + f);
}

// The face p is highest above (or least deep below), and by how much.
int highest_face(const ConvexView& v, const Vec3& p, double& most) {
  int top = 0;
  most = -HUGE_VAL;
  if (v.planes_padded) {
    for (int f = 0; f < v.faces; f += 8) {
      const Eight h = heights(v, f, p);
      const double here = largest(h);
      if (here > most) most = here, top = f + __builtin_ctz(less_equal(here, h));
    }
    return top;
  }
  for (int f = 0; f < v.faces; ++f) {
    const double h = v.nx[f] * p.x() + v.ny[f] * p.y() + v.nz[f] * p.z() - v.offset[f];
    if (h > most) most = h, top = f;
  }
  return top;
}

// q, of face f's plane, lies below all others: within the face.
bool below_others(const ConvexView& v, int face, const Vec3& q) {
  if (!v.planes_padded) return false;  // not known
  for (int f = 0; f < v.faces; f += 8) {
    unsigned above = less(0, heights(v, f, q));
    if (face / 8 == f / 8) above &= ~(1u << face % 8);
    if (v.faces - f < 8) above &= (1u << (v.faces - f)) - 1;  // repeated ones
    if (above != 0) return false;
  }
  return true;
}

}  // namespace

ClosestPoint closest_point(const ConvexView& v, const Vec3& p, int likely) {
  const auto height = [&](int f) {
    return v.nx[f] * p.x() + v.ny[f] * p.y() + v.nz[f] * p.z() - v.offset[f];
  };
  const auto below = [&](int f, double h) {
    ClosestPoint c;
    c.along = Vec3(v.nx[f], v.ny[f], v.nz[f]);
    c.point = p - h * c.along;
    c.face = f;
    c.dimension = h > 0 ? 2 : 3;
    return c;
  };
  // A face that p is straight above is the nearest, whichever was tried.
  if (likely >= 0) {
    const double h = height(likely);
    if (h > 0) {
      const ClosestPoint c = below(likely, h);
      if (below_others(v, likely, c.point)) return c;
    }
  }
  double most;
  const int top = highest_face(v, p, most);
  ClosestPoint out = below(top, most);
  if (!(most > 0) || below_others(v, top, out.point)) return out;
  double best = HUGE_VAL;  // distance squared
  if (closest_on_face(v, top, p, most, best, out)) return out;
  for (int f = 0; f < v.faces; ++f) {
    if (f == top) continue;
    const double h = height(f);
    if (h > 0 && h * h < best && closest_on_face(v, f, p, h, best, out)) return out;
  }
  return out;
}

Vec3 closest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c,
                         double weight[3]) {
  // Ericson, Real-Time Collision Detection (2005), 5.1.5.
  const auto at = [&](double u, double v, double w) -> Vec3 {
    weight[0] = u, weight[1] = v, weight[2] = w;
    return u * a + v * b + w * c;
  };
  const Vec3 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap), d3 = ab.dot(bp), d4 = ac.dot(bp), d5 = ab.dot(cp),
               d6 = ac.dot(cp);
  if (d1 <= 0 && d2 <= 0) return at(1, 0, 0);
  if (d3 >= 0 && d4 <= d3) return at(0, 1, 0);
  if (d6 >= 0 && d5 <= d6) return at(0, 0, 1);
  const double vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return at(1 - d1 / (d1 - d3), d1 / (d1 - d3), 0);
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return at(1 - d2 / (d2 - d6), 0, d2 / (d2 - d6));
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return at(0, 1 - w, w);
  }
  const double sum = va + vb + vc;
  return at(va / sum, vb / sum, vc / sum);
}

}  // namespace trackbed::dem
