#include "dem/grain/clump.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/error.h"
#include "dem/grain/principal_axes.h"
#include "dem/grain/random.h"
#include "dem/grain/scale_solid.h"

namespace trackbed::dem {
namespace {

std::vector<Sphere> candidates(const TriangleSolid& stone, double spacing, std::uint64_t seed) {
  Vec3 low = stone.vertices.front(), high = low;
  for (const Vec3& v : stone.vertices) low = low.cwiseMin(v), high = high.cwiseMax(v);
  Random random(seed);
  std::vector<Sphere> inside;
  const Eigen::Vector3i n = ((high - low) / spacing).array().ceil().cast<int>();
  for (int i = 0; i <= n[0]; ++i)
    for (int j = 0; j <= n[1]; ++j)
      for (int k = 0; k <= n[2]; ++k) {
        const double a = random.uniform(-0.25, 0.25), b = random.uniform(-0.25, 0.25);
        const Vec3 p = low + spacing * Vec3(i + a, j + b, k + random.uniform(-0.25, 0.25));
        const double r = depth(stone, p);
        if (r > 0) inside.push_back({p, r});
      }
  return inside;
}

}  // namespace

std::vector<Sphere> fill_with_spheres(const TriangleSolid& stone, const FillingParameters& p) {
  if (!(p.least_radius > 0) || !(p.space_factor >= 1) || !(p.spacing >= 0))
    throw InputError("sphere filling: R_lim must be positive, K at least 1, spacing 0 or positive");
  const double volume = mass_properties(stone).volume;
  const double spacing = p.spacing > 0 ? p.spacing : std::cbrt(volume) / 13;
  if (!(volume / std::pow(spacing, 3) < 1e7))
    throw InputError("sphere filling: the spacing is too small for the stone (over 1e7 points)");
  std::vector<Sphere> left = candidates(stone, spacing, p.seed), taken;
  std::stable_sort(left.begin(), left.end(),
                   [](const Sphere& a, const Sphere& b) { return a.radius > b.radius; });
  double least = p.least_radius;
  if (p.at_least_one && !left.empty()) least = std::min(least, left.front().radius);
  if (left.empty() || left.front().radius < least) {
    char text[160];
    std::snprintf(text, sizeof text,
                  "sphere filling: no sphere of radius %.3g m fits; the largest found has %.3g m",
                  p.least_radius, left.empty() ? 0.0 : left.front().radius);
    throw InputError(text);
  }
  while (!left.empty() && left.front().radius >= least) {
    const Sphere s = left.front();
    taken.push_back(s);
    left.erase(left.begin());
    left.erase(std::remove_if(left.begin(), left.end(),
                              [&](const Sphere& c) {
                                return (c.centre - s.centre).norm() + c.radius <=
                                       p.space_factor * s.radius;
                              }),
               left.end());
  }
  return taken;
}

ClumpShape make_clump_shape(const std::vector<Sphere>& given) {
  const MassProperties p = mass_properties(given);
  ClumpShape shape;
  shape.turn = Quat(principal_axes(p.inertia)).normalized();
  shape.origin = p.centroid;
  const Mat3 back = shape.turn.toRotationMatrix().transpose();
  for (const Sphere& s : given) {
    shape.spheres.push_back({back * (s.centre - p.centroid), s.radius});
    shape.radius = std::max(shape.radius, shape.spheres.back().centre.norm() + s.radius);
  }
  shape.volume = p.volume;
  shape.inertia = (back * p.inertia * back.transpose()).diagonal();
  return shape;
}

ClumpShape scaled(const ClumpShape& shape, double factor) {
  ClumpShape result = shape;
  scale_solid(result, factor, "clump");
  for (Sphere& s : result.spheres) s.centre *= factor, s.radius *= factor;
  return result;
}

}  // namespace trackbed::dem
