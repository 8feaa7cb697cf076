#include "dem/surface/surface_balls.h"

#include <algorithm>
#include <cmath>

#include "dem/contact/deepest_balls.h"
#include "dem/surface/shell_cell.h"

namespace trackbed::dem {
namespace {

// The point of a patch nearest to a sphere's centre. The triangles there alone say on which side
// the centre lies: one that stands beside a sleeper is behind its underside too, but farther off.
struct NearestPoint {
  double distance = HUGE_VAL;
  double height = 0;  // of the centre over the most face-on of the triangles that share the point
  Vec3 y = Vec3::Constant(HUGE_VAL), normal;
  NearTriangle on;
  double weight[3];
};

// Corners relative to the grain's centre.
struct Corners {
  Vec3 p[3];
  Corners(const SurfacePatch& patch, int triangle, const Vec3& offset) {
    for (int j = 0; j < 3; ++j) p[j] = patch.node[patch.triangle[triangle][j]] + offset;
  }
  Vec3 normal() const { return (p[1] - p[0]).cross(p[2] - p[0]).normalized(); }
};

void try_point(const Vec3& centre, const Corners& t, const NearTriangle& at, NearestPoint& best) {
  double weight[3];
  const Vec3 y = closest_on_triangle(centre, t.p[0], t.p[1], t.p[2], weight);
  const double distance = (centre - y).norm();
  // Distances that round to the same have points up to sqrt(epsilon) apart.
  const bool same = (y - best.y).squaredNorm() < 1e-14 * (t.p[0] - t.p[1]).squaredNorm();
  if (!(distance < best.distance || same)) return;
  const Vec3 normal = t.normal();
  const double height = normal.dot(centre - y);
  if (!same || std::abs(height) > std::abs(best.height)) best.height = height;
  if (!(distance < best.distance)) return;
  best.distance = distance;
  best.y = y;
  best.normal = normal;
  best.on = at;
  std::copy(weight, weight + 3, best.weight);
}

}  // namespace

SurfaceBalls sphere_on_surface(const Vec3& x, const Vec3& centre, double r,
                               const SurfacePatch& patch, const std::vector<NearTriangle>& near) {
  NearestPoint p;
  for (const NearTriangle& t : near)
    try_point(centre, Corners(patch, t.triangle, t.shift - x), t, p);
  SurfaceBalls out;
  const bool below = p.height < 0;
  // Behind the surface only what lies straight below it counts, not what lies past a border, nor
  // what has left the shell (on a sleeper).
  if (p.on.triangle < 0 || (below && p.height > -0.9 * p.distance)) return out;
  if (below && p.distance > patch.shell_depth + r) return out;
  const Vec3 up = centre - p.y;
  const bool face = p.weight[0] > 0 && p.weight[1] > 0 && p.weight[2] > 0;
  out.overlap = below ? r + p.distance : r - p.distance;
  out.reach = r;
  out.n = face || !(p.distance > 0) ? Vec3(-p.normal) : Vec3((below ? up : -up) / p.distance);
  out.y = p.y;
  out.on = p.on;
  std::copy(p.weight, p.weight + 3, out.weight);
  return out;
}

double thickness(const PartView& part, const SurfaceBalls& balls) {
  return balls.overlap + (part.radius - balls.reach) +
         part.crown / 4 * part.core.radius * part.core.radius;
}

SurfaceBalls core_on_surface(const PartView& part, const Vec3& x, const Mat3& R, const Vec3& start,
                             const SurfacePatch& patch, double aside,
                             std::vector<NearTriangle>& near) {
  SurfaceBalls best;
  const auto look_at = [&](NearTriangle& t) {
    const Corners corners(patch, t.triangle, t.shift - x);
    ShellCell solid;
    make_shell_cell(patch, 3 * t.triangle, t.shift - x, solid);
    PartView flat;
    flat.core = solid.view;
    Vec3 axis = -corners.normal();
    const DeepestBalls d =
        deepest_balls(part, R, flat, {Mat3::Identity(), solid.origin}, start, axis);
    t.overlap = d.overlap;
    t.exact = true;
    if (d.overlap <= best.overlap) return;
    best.overlap = d.overlap;
    best.reach = d.ra;
    best.n = d.n;
    best.y = closest_on_triangle(d.y, corners.p[0], corners.p[1], corners.p[2], best.weight);
    best.on = t;
  };
  // The most promising first: mostly the one of the last step, and no other is as deep.
  while (true) {
    double least = 0;
    if (best.overlap > 0)  // flat parts may not reach the surface: no thickness
      least = aside > 0 ? std::min(best.overlap, -aside * thickness(part, best)) : best.overlap;
    NearTriangle* next = nullptr;
    for (NearTriangle& t : near)
      if (!t.exact && t.overlap > least) least = t.overlap, next = &t;
    if (!next) return best;
    look_at(*next);
  }
}

}  // namespace trackbed::dem
