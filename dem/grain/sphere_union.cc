#include "dem/grain/sphere_union.h"

#include <cmath>

#include "base/error.h"
#include "dem/grain/disc_region.h"

namespace trackbed::dem {
namespace {

struct Cut {
  Vec3 n;    // outward
  double h;  // of the plane from the sphere's centre
  int other;
};

// Keeps the part of the polygon where l.x <= c.
void clip(std::vector<Vec2>& polygon, const Vec2& l, double c, std::vector<Vec2>& work) {
  work.clear();
  for (size_t k = 0; k < polygon.size(); ++k) {
    const Vec2 &a = polygon[k], &b = polygon[(k + 1) % polygon.size()];
    const double sa = l.dot(a) - c, sb = l.dot(b) - c;
    if (sa <= 0) work.push_back(a);
    if ((sa < 0 && sb > 0) || (sa > 0 && sb < 0)) work.push_back(a + sa / (sa - sb) * (b - a));
  }
  polygon.swap(work);
}

// The planes that cut sphere i from its neighbours; false when another sphere holds all of it.
bool cuts_of(const std::vector<Sphere>& spheres, int i, std::vector<Cut>& cuts) {
  cuts.clear();
  const Sphere& s = spheres[i];
  for (int j = 0; j < int(spheres.size()); ++j) {
    if (j == i) continue;
    const Vec3 d = spheres[j].centre - s.centre;
    const double r = spheres[j].radius, distance = d.norm();
    if (distance >= s.radius + r) continue;
    if (distance <= r - s.radius && (distance > 0 || r > s.radius || j < i)) return false;
    if (distance <= s.radius - r) continue;  // it lies inside this one
    const double h = 0.5 * (distance + (s.radius - r) * (s.radius + r) / distance);
    cuts.push_back({d / distance, h, j});
  }
  return true;
}

struct Integrals {
  double volume = 0;
  Vec3 first = Vec3::Zero();
  Mat3 second = Mat3::Zero();
};

// The part of the disc in which plane `c` bounds the sphere's cell, in the plane's axes (e1, e2).
DiscRegion cut_region(const std::vector<Cut>& cuts, const Cut& c, const Vec3& e1, const Vec3& e2,
                      double radius, std::vector<Vec2>& polygon, std::vector<Vec2>& work) {
  const double rho = std::sqrt(std::max(0.0, (radius - c.h) * (radius + c.h)));
  polygon = {{-2 * rho, -2 * rho}, {2 * rho, -2 * rho}, {2 * rho, 2 * rho}, {-2 * rho, 2 * rho}};
  for (const Cut& k : cuts) {
    if (k.other == c.other) continue;
    const Vec2 l(k.n.dot(e1), k.n.dot(e2));
    const double rest = k.h - c.h * c.n.dot(k.n);
    if (l.norm() * rho < 1e-12 * radius) {  // parallel; of two planes at one place the first counts
      if (rest < -1e-12 * radius) return {};
      if (rest < 1e-12 * radius && c.n.dot(k.n) > 0 && k.other < c.other) return {};
      continue;
    }
    clip(polygon, l, rest, work);
    if (polygon.size() < 3) return {};
  }
  return disc_within(polygon, rho, c.h, radius);
}

// Sphere i's part of the union, relative to its centre.
Integrals part(const std::vector<Sphere>& spheres, int i, std::vector<Cut>& cuts) {
  Integrals sum;
  if (!cuts_of(spheres, i, cuts)) return sum;
  const double r = spheres[i].radius;
  bool centre_inside = true;
  double flat_angle = 0;
  Vec3 flat_normal = Vec3::Zero();  // sum n |G|
  Mat3 flat_moment = Mat3::Zero();  // sum n <x>'
  std::vector<Vec2> polygon, work;
  for (const Cut& c : cuts) {
    if (c.h < 0) centre_inside = false;
    const Vec3 e1 = c.n.unitOrthogonal(), e2 = c.n.cross(e1);
    const DiscRegion g = cut_region(cuts, c, e1, e2, r, polygon, work);
    Eigen::Matrix<double, 3, 2> axes;
    axes << e1, e2;
    const Vec3 foot = c.h * c.n, in_plane = axes * g.first, first = in_plane + g.area * foot;
    const Mat3 second = axes * g.second * axes.transpose() + in_plane * foot.transpose() +
                        foot * in_plane.transpose() + g.area * foot * foot.transpose();
    sum.volume += c.h / 3 * g.area;
    sum.first += c.h / 4 * first;
    sum.second += c.h / 5 * second;
    flat_angle += g.angle;
    flat_normal += g.area * c.n;
    flat_moment += c.n * first.transpose();
  }
  const double angle = (centre_inside ? 4 * M_PI : 0) - flat_angle;
  sum.volume += r * r * r / 3 * angle;
  sum.first -= r * r / 4 * flat_normal;
  sum.second +=
      r * r / 5 * (sum.volume * Mat3::Identity() - 0.5 * (flat_moment + flat_moment.transpose()));
  return sum;
}

void check(const std::vector<Sphere>& spheres) {
  if (spheres.empty()) throw InputError("clump: there is no sphere");
  for (size_t i = 0; i < spheres.size(); ++i)
    if (!(spheres[i].radius > 0) || !std::isfinite(spheres[i].radius) ||
        !spheres[i].centre.allFinite())
      throw InputError("clump: sphere " + std::to_string(i) +
                       " needs a positive radius and finite coordinates");
}

}  // namespace

MassProperties mass_properties(const std::vector<Sphere>& spheres) {
  check(spheres);
  std::vector<Cut> cuts;
  std::vector<Integrals> parts;
  MassProperties p;
  const Vec3 o = spheres.front().centre;
  for (int i = 0; i < int(spheres.size()); ++i) {
    parts.push_back(part(spheres, i, cuts));
    p.volume += parts[i].volume;
    p.centroid += parts[i].first + parts[i].volume * (spheres[i].centre - o);
  }
  p.centroid = o + p.centroid / p.volume;
  Mat3 c = Mat3::Zero();
  for (size_t i = 0; i < spheres.size(); ++i) {
    const Vec3 d = spheres[i].centre - p.centroid;
    c += parts[i].second + parts[i].first * d.transpose() + d * parts[i].first.transpose() +
         parts[i].volume * d * d.transpose();
  }
  p.inertia = -0.5 * (c + c.transpose());
  for (int i = 0; i < 3; ++i)
    p.inertia(i, i) = c((i + 1) % 3, (i + 1) % 3) + c((i + 2) % 3, (i + 2) % 3);
  return p;
}

}  // namespace trackbed::dem
