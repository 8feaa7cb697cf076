// Virtual slices of sphere_union.h.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/error.h"
#include "dem/grain/sphere_union.h"

namespace trackbed::dem {
namespace {

using Arc = std::pair<double, double>;  // angles from, to; from in [0, 2 pi)

void add_arc(std::vector<Arc>& arcs, double middle, double half) {
  double from = middle - half;
  if (from < 0) from += 2 * M_PI;
  const double to = from + 2 * half;
  arcs.emplace_back(from, std::min(to, 2 * M_PI));
  if (to > 2 * M_PI) arcs.emplace_back(0, to - 2 * M_PI);
}

// The arcs of disc i that others cover; false when one covers all of it.
bool covered_arcs(const std::vector<Disc>& discs, size_t i, std::vector<Arc>& arcs) {
  arcs.clear();
  const Disc& a = discs[i];
  for (size_t j = 0; j < discs.size(); ++j) {
    if (j == i) continue;
    const Disc& b = discs[j];
    const double dx = b.x - a.x, dy = b.y - a.y, d = std::hypot(dx, dy);
    if (d >= a.radius + b.radius) continue;
    if (d <= b.radius - a.radius && (d > 0 || b.radius > a.radius || j < i)) return false;
    if (d <= a.radius - b.radius) continue;
    const double reach =
        (d * d + (a.radius - b.radius) * (a.radius + b.radius)) / (2 * d * a.radius);
    add_arc(arcs, std::atan2(dy, dx), std::acos(std::max(-1.0, std::min(1.0, reach))));
  }
  return true;
}

// Integral of (x dy - y dx) / 2 along the arcs that are not covered.
double free_arcs(const Disc& d, std::vector<Arc>& arcs) {
  double area = 0;
  std::sort(arcs.begin(), arcs.end());
  const auto add_free = [&](double from, double to) {
    area += 0.5 * d.radius *
            (d.radius * (to - from) + d.x * (std::sin(to) - std::sin(from)) -
             d.y * (std::cos(to) - std::cos(from)));
  };
  double reached = 0;
  for (const Arc& arc : arcs) {
    if (arc.first > reached) add_free(reached, arc.first);
    reached = std::max(reached, arc.second);
  }
  if (reached < 2 * M_PI) add_free(reached, 2 * M_PI);
  return area;
}

// The length of [0, length] of a line (from `start` along the unit `along`) that the discs cover.
double covered_length(const std::vector<Disc>& discs, const Vec2& start, const Vec2& along,
                      double length) {
  std::vector<std::pair<double, double>> pieces;
  for (const Disc& d : discs) {
    const Vec2 c = Vec2(d.x, d.y) - start;
    const double middle = c.dot(along), off = c.x() * along.y() - c.y() * along.x();
    const double half2 = (d.radius - off) * (d.radius + off);
    if (half2 <= 0) continue;
    const double half = std::sqrt(half2);
    pieces.emplace_back(std::max(0.0, middle - half), std::min(length, middle + half));
  }
  std::sort(pieces.begin(), pieces.end());
  double covered = 0, reached = 0;
  for (const auto& [from, to] : pieces) {
    covered += std::max(0.0, to - std::max(from, reached));
    reached = std::max(reached, to);
  }
  return covered;
}

}  // namespace

std::vector<Disc> slice(const std::vector<Sphere>& spheres, double z) {
  std::vector<Disc> discs;
  for (const Sphere& s : spheres) {
    const double d = z - s.centre.z(), r2 = (s.radius - d) * (s.radius + d);
    if (r2 > 0) discs.push_back({s.centre.x(), s.centre.y(), std::sqrt(r2)});
  }
  return discs;
}

double union_area(const std::vector<Disc>& discs) {
  double area = 0;
  std::vector<Arc> arcs;
  for (size_t i = 0; i < discs.size(); ++i)
    if (covered_arcs(discs, i, arcs)) area += free_arcs(discs[i], arcs);
  return area;
}

double union_area_in_disc(std::vector<Disc> discs, const Vec2& centre, double radius) {
  const double without = union_area(discs);
  discs.push_back({centre.x(), centre.y(), radius});
  return without + M_PI * radius * radius - union_area(discs);
}

double union_area_in_rectangle(const std::vector<Disc>& discs, const Vec2& low, const Vec2& high) {
  // The outline's arcs inside, from the rectangle's low corner, and what the discs cover of the two
  // sides that do not pass through it (the other two add nothing to (x dy - y dx) / 2).
  const Vec2 size = high - low;
  std::vector<Disc> moved;
  for (const Disc& d : discs) moved.push_back({d.x - low.x(), d.y - low.y(), d.radius});
  double area = 0;
  std::vector<Arc> arcs;
  for (size_t i = 0; i < moved.size(); ++i) {
    if (!covered_arcs(moved, i, arcs)) continue;
    const Disc& d = moved[i];
    const double to_side[4] = {size.x() - d.x, size.y() - d.y, d.x, d.y};
    for (int side = 0; side < 4; ++side)
      if (to_side[side] < d.radius)
        add_arc(arcs, 0.5 * M_PI * side,
                to_side[side] > -d.radius ? std::acos(to_side[side] / d.radius) : M_PI);
    area += free_arcs(d, arcs);
  }
  area += 0.5 * size.x() * covered_length(moved, Vec2(size.x(), 0), Vec2::UnitY(), size.y());
  area += 0.5 * size.y() * covered_length(moved, Vec2(0, size.y()), Vec2::UnitX(), size.x());
  return area;
}

double sliced_volume(const std::vector<Sphere>& spheres, int slices) {
  if (spheres.empty()) throw InputError("clump: there is no sphere");
  if (slices < 1) throw InputError("clump: at least one slice is needed");
  double least = std::numeric_limits<double>::infinity(), low = least, high = -least;
  for (const Sphere& s : spheres) {
    if (!(s.radius > 0) || !s.centre.allFinite())
      throw InputError("clump: a sphere needs a positive radius and finite coordinates");
    least = std::min(least, s.radius);
    low = std::min(low, s.centre.z() - s.radius), high = std::max(high, s.centre.z() + s.radius);
  }
  const long n = std::max(1l, std::lround((high - low) / (2 * least) * slices));
  const double thickness = (high - low) / double(n);
  double volume = 0;
  for (long k = 0; k < n; ++k)
    volume += thickness * union_area(slice(spheres, low + (double(k) + 0.5) * thickness));
  return volume;
}

}  // namespace trackbed::dem
