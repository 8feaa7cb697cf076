#include "dem/grading/direction_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace trackbed::dem {
namespace {

struct Cell {
  int face;           // of the cube map, u ~ axis + a e1 + b e2
  double a, b, half;  // centre and half edge in the chart
  double bound;       // certified below every value inside
};

Vec3 direction(int face, double a, double b) {
  Vec3 u;
  u[face] = 1, u[(face + 1) % 3] = a, u[(face + 2) % 3] = b;
  return u.normalized();
}

}  // namespace

double lowest_near(double value, double radius2, double c, double s) {
  return value * c - std::sqrt(std::max(0.0, radius2 - value * value)) * s;
}
double highest_near(double value, double radius2, double c, double s) {
  if (value * value >= radius2 * c * c) return std::sqrt(radius2);
  return value * c + std::sqrt(std::max(0.0, radius2 - value * value)) * s;
}

DirectionSearch::DirectionSearch() { best_.size = std::numeric_limits<double>::infinity(); }

DirectionSearch::Bounds DirectionSearch::evaluate_and_keep(const Vec3& u, double c, double s) {
  ++best_.evaluations;
  const Bounds r = evaluate(u, c, s);
  const double value = std::max(r.w, r.g);
  if (value < best_.size) best_.size = value, best_.u = u, best_.v = r.v;
  return r;
}

// Walks downhill from u with shrinking steps; the value falls linearly to a corner.
void DirectionSearch::descend(Vec3 u, double step) {
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
double DirectionSearch::value_at(const Vec3& u) {
  const Bounds b = evaluate_and_keep(u, 1, 0);
  return b.w >= best_.size ? b.w : std::max(b.w, b.g);
}

ExactSieveSize DirectionSearch::run(double tolerance) {
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
      const Bounds r = evaluate_and_keep(u, std::cos(t), std::sin(t));
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

}  // namespace trackbed::dem
