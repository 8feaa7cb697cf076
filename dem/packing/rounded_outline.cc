#include <cmath>

#include "base/error.h"
#include "dem/grain/dilated.h"
#include "dem/packing/measure.h"

namespace trackbed::dem {
namespace {

// Points spread evenly over the unit sphere (Fibonacci's spiral).
std::vector<Vec3> sphere_points(int count) {
  std::vector<Vec3> points;
  for (int k = 0; k < count; ++k) {
    const double z = 1 - (2 * k + 1.0) / count, r = std::sqrt(1 - z * z);
    const double angle = M_PI * (3 - std::sqrt(5.0)) * k;
    points.emplace_back(r * std::cos(angle), r * std::sin(angle), z);
  }
  return points;
}

}  // namespace

Polyhedron rounded_outline(const Polyhedron& core, double radius) {
  if (!(radius >= 0) || !std::isfinite(radius))
    throw InputError("dilated polyhedron: the radius must be finite and not negative");
  if (radius == 0) return core;
  static const std::vector<Vec3> directions = sphere_points(200);
  const auto hull_of = [&](double reach) {
    std::vector<Vec3> points;
    for (const Vec3& v : core.vertices)
      for (const Vec3& d : directions) points.push_back(v + reach * d);
    return convex_hull(points);
  };
  // The ball is made a little larger, so that the volume comes right: one step of Newton's method,
  // dV/dr by Steiner's formula.
  const double r = radius, h = 1e-4 * r;
  const double slope = (dilated_volume({core, r + h}) - dilated_volume({core, r - h})) / (2 * h);
  const double missing = dilated_volume({core, r}) - mass_properties(hull_of(r)).volume;
  return hull_of(r + missing / slope);
}

}  // namespace trackbed::dem
