// exact_sieve_size of sieve_size.h.
//
// g(u) is attained with a side of the shadow, that is v = e x u for a silhouette edge e.
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
#include "dem/grading/direction_search.h"
#include "dem/grading/shadow.h"
#include "dem/grading/sieve_size.h"

namespace trackbed::dem {
namespace {

class Search : public DirectionSearch {
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
  }

 private:
  struct Edge {
    int left, right;  // faces
    Vec3 e;
    double length;
  };

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

  Bounds evaluate(const Vec3& u, double c, double s) override {
    Bounds r;
    r.w = width(u);
    r.w_low = lowest_near(r.w, longest_active2(), c, s);
    r.w_high = highest_near(r.w, diameter2_, c, s);
    r.g = r.g_low = std::numeric_limits<double>::infinity();
    if (r.w_low >= best().size) return r;  // w alone rules it out
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
      if (lowest_near(wv, diameter2_, c, s) <
          r.g_low)  // else the tighter bound is not the least either
        r.g_low = std::min(r.g_low, lowest_near(wv, longest_active2(), c, s));
      // The cap can neither be pruned nor left to the exchanged pair: the rest does not matter.
      if (r.g_low < best().size && r.g_low <= r.w_high && r.g <= r.w) {
        std::swap(edges_[k], edges_[k / 2]);  // likely to decide the next one, too
        break;
      }
    }
    return r;
  }

  std::vector<Vec3> corners_;            // about their mean
  std::vector<double> x_, y_, z_, dot_;  // the same, for the inner loop
  double high_ = 0, low_ = 0;
  std::vector<Vec3> normals_;
  std::vector<double> side_;
  std::vector<Edge> edges_;
  std::vector<int> top_, bottom_;
  double diameter2_ = 0;
};

}  // namespace

ExactSieveSize exact_sieve_size(const Polyhedron& body, double tolerance) {
  mass_properties(body);  // throws when it is no solid
  return Search(body).run(tolerance);
}

}  // namespace trackbed::dem
