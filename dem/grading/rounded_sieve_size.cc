#include "dem/grading/rounded_sieve_size.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "dem/grading/direction_search.h"
#include "dem/grading/disc_hull.h"
#include "dem/grading/shadow.h"
#include "dem/grain/principal_axes.h"

namespace trackbed::dem {
namespace {

// Widths of a clump. Bounds for all u' within the angle t of u: every pair (d, rho) gives
// w(u') >= (d.u) cos t - |d - (d.u)u| sin t + rho; w(u') >= 2 R of the largest sphere; and
// w(u') <= w(u) + 2 sin(t/2) D, D the largest distance of two centres.
// g(u): the outline of the shadow is the hull of discs. Between two of its straight sides one pair
// is extreme, where d.v + rho is concave in the angle and its bound rises with d.v: both are least
// at the sides.
class ClumpSearch : public DirectionSearch {
 public:
  explicit ClumpSearch(const std::vector<Sphere>& spheres) {
    Vec3 middle = Vec3::Zero();
    for (const Sphere& s : spheres) middle += s.centre / double(spheres.size());
    for (const Sphere& s : spheres) {
      spheres_.push_back({s.centre - middle, s.radius});
      widest_ = std::max(widest_, 2 * s.radius);
    }
    for (const Sphere& a : spheres_)
      for (const Sphere& b : spheres_)
        diameter_ = std::max(diameter_, (a.centre - b.centre).norm());
    discs_.resize(spheres_.size());
  }

  double width(const Vec3& u, int* top = nullptr, int* bottom = nullptr) const {
    double high = -std::numeric_limits<double>::infinity(), low = -high;
    for (int i = 0; i < int(spheres_.size()); ++i) {
      const double t = spheres_[i].centre.dot(u), r = spheres_[i].radius;
      if (t + r > high && (high = t + r, top)) *top = i;
      if (t - r < low && (low = t - r, bottom)) *bottom = i;
    }
    return high - low;
  }

  // Directions of the shadow along u, angles in [0, pi) from e1, in which the extreme pair changes.
  struct Piece {
    double from, to;
    int top, bottom;
  };
  const std::vector<Piece>& pieces(const Vec3& e1, const Vec3& e2) {
    for (size_t i = 0; i < discs_.size(); ++i)
      discs_[i] = {spheres_[i].centre.dot(e1), spheres_[i].centre.dot(e2), spheres_[i].radius};
    const std::vector<HullArc> arcs = disc_hull(discs_);
    std::vector<double>& turns = turns_;
    turns = {0, M_PI};
    for (const HullArc& a : arcs) turns.push_back(a.angle < M_PI ? a.angle : a.angle - M_PI);
    std::sort(turns.begin(), turns.end());
    pieces_.clear();
    const auto at = [&](double angle) {
      auto it = std::upper_bound(arcs.begin(), arcs.end(), angle,
                                 [](double x, const HullArc& a) { return x < a.angle; });
      return std::prev(it)->disc;
    };
    for (size_t k = 0; k + 1 < turns.size(); ++k) {
      if (turns[k + 1] - turns[k] < 1e-15) continue;
      const double middle = 0.5 * (turns[k] + turns[k + 1]);
      pieces_.push_back({turns[k], turns[k + 1], at(middle), at(middle + M_PI)});
    }
    return pieces_;
  }

 private:
  double pair_low(int i, int j, const Vec3& u, double c, double s) const {
    const Vec3 d = spheres_[i].centre - spheres_[j].centre;
    const double along = d.dot(u), across2 = std::max(0.0, d.squaredNorm() - along * along);
    return along * c - std::sqrt(across2) * s + spheres_[i].radius + spheres_[j].radius;
  }

  Bounds evaluate(const Vec3& u, double c, double s) override {
    Bounds r;
    int top = 0, bottom = 0;
    r.w = width(u, &top, &bottom);
    r.w_low = std::max(widest_, pair_low(top, bottom, u, c, s));
    r.w_high = r.w + std::sqrt(std::max(0.0, 2 * (1 - c))) * diameter_;
    r.g = r.g_low = std::numeric_limits<double>::infinity();
    if (r.w_low >= best().size) return r;
    const Vec3 e1 = u.unitOrthogonal(), e2 = u.cross(e1);
    for (const Piece& p : pieces(e1, e2)) {
      for (const double angle : {p.from, p.to}) {
        const Vec3 v = std::cos(angle) * e1 + std::sin(angle) * e2;
        r.g_low = std::min(r.g_low, pair_low(p.top, p.bottom, v, c, s));
        const double w = pair_low(p.top, p.bottom, v, 1, 0);
        if (w < r.g) r.g = w, r.v = v;
      }
    }
    r.g = width(r.v);  // the pair's value is within rounding of it
    r.g_low = std::max(r.g_low, widest_);
    return r;
  }

  std::vector<Sphere> spheres_;
  double widest_ = 0, diameter_ = 0;
  std::vector<Disc> discs_;
  std::vector<double> turns_;
  std::vector<Piece> pieces_;
};

double equal_size(double volume, SieveMethod method) {
  if (method == SieveMethod::equal_cube) return std::cbrt(volume);
  if (method == SieveMethod::equal_sphere) return std::cbrt(6 * volume / M_PI);
  throw InputError("sieve size: the method '" + to_string(method) +
                   "' is defined for polyhedra only; use exact, elias2014, equal_sphere or "
                   "equal_cube for clumps and dilated grains");
}

}  // namespace

ExactSieveSize exact_sieve_size(const std::vector<Sphere>& spheres, double tolerance) {
  mass_properties(spheres);  // throws on wrong spheres
  return ClumpSearch(spheres).run(tolerance);
}

double sieve_size(const std::vector<Sphere>& spheres, SieveMethod method) {
  if (method == SieveMethod::exact) return exact_sieve_size(spheres).size;
  const MassProperties p = mass_properties(spheres);
  if (method != SieveMethod::elias2014) return equal_size(p.volume, method);
  const Mat3 axes = principal_axes(p.inertia);
  ClumpSearch widths(spheres);
  double least = std::numeric_limits<double>::infinity();
  for (const auto& piece : widths.pieces(axes.col(1), axes.col(2))) {
    const double c = std::cos(piece.from), s = std::sin(piece.from);
    least = std::min(least, std::max(widths.width(c * axes.col(1) + s * axes.col(2)),
                                     widths.width(c * axes.col(2) - s * axes.col(1))));
  }
  return least;
}

double sieve_size(const DilatedPolyhedron& body, SieveMethod method) {
  const MassProperties p = mass_properties(body);
  if (method == SieveMethod::exact) return exact_sieve_size(body.core).size + 2 * body.radius;
  if (method != SieveMethod::elias2014) return equal_size(p.volume, method);
  return least_flush_square(shadow(body.core, principal_axes(p.inertia).col(0))) + 2 * body.radius;
}

}  // namespace trackbed::dem
