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
    const double half = std::acos(std::max(-1.0, std::min(1.0, reach)));
    double from = std::atan2(dy, dx) - half;
    if (from < 0) from += 2 * M_PI;
    const double to = from + 2 * half;
    arcs.emplace_back(from, std::min(to, 2 * M_PI));
    if (to > 2 * M_PI) arcs.emplace_back(0, to - 2 * M_PI);
  }
  std::sort(arcs.begin(), arcs.end());
  return true;
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
  for (size_t i = 0; i < discs.size(); ++i) {
    if (!covered_arcs(discs, i, arcs)) continue;
    const Disc& d = discs[i];
    const auto add_free = [&](double from, double to) {  // (x dy - y dx) / 2 along the arc
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
  }
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
