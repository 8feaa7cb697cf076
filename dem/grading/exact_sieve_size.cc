// exact_sieve_size of sieve_size.h.
//
// f* = min over orthonormal (u, v) of max(w(u), w(v)) = min over u of max(w(u), g(u)), where
// g(u) = min over v orthogonal to u of w(v) is the least width of the shadow along u; it is
// attained with a side of the shadow, that is v = e x u for a silhouette edge e. By symmetry of u
// and v it is enough to search where w(u) >= g(u): otherwise exchange the two. Without that, a box
// 64 x 30 x 100 has a whole arc of optimal u; with it optima are isolated corners, towards which
// bounds close in linearly.
//
// Bounds for all u' within the angle t of u, from w(u) = max of d.u over differences d of vertices:
//   d.u' >= d.u cos t - |d - (d.u)u| sin t                           w(u') >= the largest of these
//   w(u') <= w(u) cos t + sqrt(D^2 - w^2) sin t                      D = diameter of the grain
//   g(u'): any v' orthogonal to u' lies within t of some v orthogonal to u. Between two silhouette
//   edges one difference d is active and its bound rises with d.v, so the least bound is found at
//   the silhouette edges, with the longest of the differences active there.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "base/error.h"
#include "dem/grading/shadow.h"
#include "dem/grading/sieve_size.h"

namespace trackbed::dem {
namespace {

// As |cos|, but the interval may reach the maximum: largest and least value of R cos over
// angles within t of the one where it is `value` (R >= value >= 0).
double lowest(double value, double radius2, double c, double s) {
  return value * c - std::sqrt(std::max(0.0, radius2 - value * value)) * s;
}
double highest(double value, double radius2, double c, double s) {
  if (value * value >= radius2 * c * c) return std::sqrt(radius2);
  return value * c + std::sqrt(std::max(0.0, radius2 - value * value)) * s;
}

struct Cell {
  int face;           // of the cube map, u ~ axis + a e1 + b e2
  double a, b, half;  // centre and half edge in the chart
  double bound;       // certified below every value inside
};

// Value and bounds at u for the cap of cosine c, sine s.
struct Bounds {
  double w = 0, g = 0;
  double w_low = 0, w_high = 0, g_low = 0;
  Vec3 v = Vec3::Zero();
};

class Search {
 public:
  explicit Search(const Polyhedron& body) : dot_(body.vertices.size()) {
    Vec3 middle = Vec3::Zero();
    for (const Vec3& p : body.vertices) middle += p / double(body.vertices.size());
    for (const Vec3& p : body.vertices) {
      corners_.push_back(p - middle);
      x_.push_back(corners_.back().x());
      y_.push_back(corners_.back().y());
      z_.push_back(corners_.back().z());
    }
    for (const Vec3& p : corners_)
      for (const Vec3& q : corners_) diameter2_ = std::max(diameter2_, (p - q).squaredNorm());
    normals_ = face_areas(body);
    std::map<std::pair<int, int>, int> owner;
    for (int f = 0; f < int(body.faces.size()); ++f) {
      const auto& face = body.faces[f];
      for (size_t k = 0; k < face.size(); ++k) owner[{face[k], face[(k + 1) % face.size()]}] = f;
    }
    for (const auto& [edge, f] : owner) {
      const auto other = owner.find({edge.second, edge.first});
      if (other == owner.end()) throw InputError("sieve size: the surface is not closed");
      if (edge.first > edge.second) continue;
      const Vec3 e = corners_[edge.second] - corners_[edge.first];
      edges_.push_back({f, other->second, e, e.norm()});
    }
    side_.resize(normals_.size());
    best_.size = std::numeric_limits<double>::infinity();
  }

  ExactSieveSize run(double tolerance);

 private:
  struct Edge {
    int left, right;  // faces
    Vec3 e;
    double length;
  };

  static Vec3 direction(int face, double a, double b) {
    Vec3 u;
    u[face] = 1, u[(face + 1) % 3] = a, u[(face + 2) % 3] = b;
    return u.normalized();
  }

  // Width along d; leaves the corners' coordinates along d in dot_.
  double width(const Vec3& d) {
    double high = -std::numeric_limits<double>::infinity(), low = -high;
    const int n = int(dot_.size());
    const double dx = d.x(), dy = d.y(), dz = d.z();
#pragma omp simd reduction(max : high) reduction(min : low)
    for (int i = 0; i < n; ++i) {
      const double t = x_[i] * dx + y_[i] * dy + z_[i] * dz;
      dot_[i] = t;
      high = std::max(high, t);
      low = std::min(low, t);
    }
    high_ = high, low_ = low;
    return high - low;
  }

  // After width(): squared length of the longest difference of corners that attains it.
  double longest_active2() {
    const double tie = 1e-9 * (high_ - low_) + 1e-14 * std::sqrt(diameter2_);
    top_.clear(), bottom_.clear();
    for (int i = 0; i < int(dot_.size()); ++i) {
      if (dot_[i] >= high_ - tie) top_.push_back(i);
      if (dot_[i] <= low_ + tie) bottom_.push_back(i);
    }
    double longest2 = 0;
    for (int i : top_)
      for (int j : bottom_)
        longest2 = std::max(longest2, (corners_[i] - corners_[j]).squaredNorm());
    return longest2;
  }

  Bounds evaluate(const Vec3& u, double c, double s) {
    Bounds r;
    r.w = width(u);
    r.w_low = lowest(r.w, longest_active2(), c, s);
    r.w_high = highest(r.w, diameter2_, c, s);
    r.g = r.g_low = std::numeric_limits<double>::infinity();
    ++best_.evaluations;
    if (r.w_low >= best_.size) return r;  // w alone rules it out
    for (size_t f = 0; f < normals_.size(); ++f) side_[f] = normals_[f].dot(u);
    for (size_t k = 0; k < edges_.size(); ++k) {
      const Edge& edge = edges_[k];
      if ((side_[edge.left] > 0) == (side_[edge.right] > 0)) continue;
      Vec3 v = edge.e.cross(u);
      const double length = v.norm();
      if (length <= 1e-12 * edge.length) continue;  // along u: a corner of the shadow, no side
      v /= length;
      const double wv = width(v);
      if (wv < r.g) r.g = wv, r.v = v;
      if (lowest(wv, diameter2_, c, s) < r.g_low)  // else the tighter bound is not the least either
        r.g_low = std::min(r.g_low, lowest(wv, longest_active2(), c, s));
      // The cap can neither be pruned nor left to the exchanged pair: the rest does not matter.
      if (r.g_low < best_.size && r.g_low <= r.w_high && r.g <= r.w) {
        std::swap(edges_[k], edges_[k / 2]);  // likely to decide the next one, too
        break;
      }
    }
    const double value = std::max(r.w, r.g);
    if (value < best_.size) best_.size = value, best_.u = u, best_.v = r.v;
    return r;
  }

  // Walks downhill from u with shrinking steps; the value falls linearly to a corner.
  void descend(Vec3 u, double step) {
    double value = value_at(u);
    for (; step > 1e-12; step *= 0.5) {
      for (bool moved = true; moved;) {
        moved = false;
        const Vec3 e1 = u.unitOrthogonal(), e2 = u.cross(e1);
        for (int k = 0; k < 12; ++k) {
          const double t = k * (2 * M_PI / 12);
          const Vec3 next = (u + step * (std::cos(t) * e1 + std::sin(t) * e2)).normalized();
          const double there = value_at(next);
          if (there < value - 1e-3 * step * value) {
            value = there, u = next, moved = true;
            break;
          }
        }
      }
    }
  }
  double value_at(const Vec3& u) {
    const Bounds b = evaluate(u, 1, 0);
    return b.w >= best_.size ? b.w : std::max(b.w, b.g);
  }

  std::vector<Vec3> corners_;            // about their mean
  std::vector<double> x_, y_, z_, dot_;  // the same, for the inner loop
  double high_ = 0, low_ = 0;
  std::vector<Vec3> normals_;
  std::vector<double> side_;
  std::vector<Edge> edges_;
  std::vector<int> top_, bottom_;
  double diameter2_ = 0;
  ExactSieveSize best_;
};

ExactSieveSize Search::run(double tolerance) {
  std::vector<Cell> level, next;
  const int n = 4;  // cells along an edge of a face of the cube map; u and -u are the same
  for (int face = 0; face < 3; ++face)
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        level.push_back({face, (2 * i + 1.0) / n - 1, (2 * j + 1.0) / n - 1, 1.0 / n, 0});
  double pruned = std::numeric_limits<double>::infinity();  // least bound of what was given up
  for (int depth = 0; depth < 48 && !level.empty(); ++depth) {
    next.clear();
    const double before = best_.size;
    for (const Cell& cell : level) {
      if (cell.bound >= best_.size * (1 - tolerance)) {
        pruned = std::min(pruned, cell.bound);
        continue;
      }
      const Vec3 u = direction(cell.face, cell.a, cell.b);
      // The chart shrinks lengths: the cap of angle half*sqrt2 about the centre holds the cell.
      const double t = cell.half * std::sqrt(2.0);
      const Bounds r = evaluate(u, std::cos(t), std::sin(t));
      const double bound = std::max(r.w_low, r.g_low);
      if (bound >= best_.size * (1 - tolerance)) {
        pruned = std::min(pruned, bound);
        continue;
      }
      if (r.w_high < r.g_low) continue;  // covered with u and v exchanged
      const double h = 0.5 * cell.half;
      for (int k = 0; k < 4; ++k)
        next.push_back({cell.face, cell.a + (k & 1 ? h : -h), cell.b + (k & 2 ? h : -h), h, bound});
    }
    if (best_.size < before) descend(best_.u, 0.5 / n * std::pow(0.5, depth));
    std::swap(level, next);
    if (level.size() > 1000000) break;
  }
  for (const Cell& cell : level) pruned = std::min(pruned, cell.bound);
  best_.lower_bound = std::min(best_.size, pruned);
  return best_;
}

}  // namespace

ExactSieveSize exact_sieve_size(const Polyhedron& body, double tolerance) {
  mass_properties(body);  // throws when it is no solid
  return Search(body).run(tolerance);
}

}  // namespace trackbed::dem
