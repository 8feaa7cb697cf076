#include "dem/grain/triangle_solid.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"

namespace trackbed::dem {
namespace {

double distance_to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 d = b - a;
  const double t = std::max(0.0, std::min(1.0, (p - a).dot(d) / d.squaredNorm()));
  return (p - a - t * d).norm();
}

double distance_to_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 n = (b - a).cross(c - a);
  const bool above = n.dot((b - a).cross(p - a)) >= 0 && n.dot((c - b).cross(p - b)) >= 0 &&
                     n.dot((a - c).cross(p - c)) >= 0;
  if (above && n.norm() > 0) return std::abs((p - a).dot(n)) / n.norm();
  return std::min(
      {distance_to_segment(p, a, b), distance_to_segment(p, b, c), distance_to_segment(p, c, a)});
}

// Of the triangle a, b, c seen from the origin (Van Oosterom and Strackee 1983).
double solid_angle(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  return 2 * std::atan2(a.dot(b.cross(c)),
                        la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
}

}  // namespace

MassProperties mass_properties(const TriangleSolid& solid) {
  Polyhedron same{solid.vertices, {}};
  for (const auto& t : solid.triangles) same.faces.push_back({t[0], t[1], t[2]});
  return mass_properties(same);
}

double depth(const TriangleSolid& solid, const Vec3& point) {
  double nearest = std::numeric_limits<double>::infinity(), angle = 0;
  for (const auto& t : solid.triangles) {
    const Vec3 &a = solid.vertices[t[0]], &b = solid.vertices[t[1]], &c = solid.vertices[t[2]];
    nearest = std::min(nearest, distance_to_triangle(point, a, b, c));
    angle += solid_angle(a - point, b - point, c - point);
  }
  return angle > 2 * M_PI ? nearest : -nearest;
}

std::vector<Polyhedron> star_parts(const TriangleSolid& solid, const Vec3& centre) {
  std::vector<Polyhedron> parts;
  for (const auto& t : solid.triangles) {
    const Vec3 &a = solid.vertices[t[0]], &b = solid.vertices[t[1]], &c = solid.vertices[t[2]];
    if (!((a - centre).dot((b - centre).cross(c - centre)) > 0))
      throw InputError("triangle solid: its surface is not all seen from the centre");
    parts.push_back({{centre, a, b, c}, {{1, 2, 3}, {0, 2, 1}, {0, 3, 2}, {0, 1, 3}}});
  }
  return parts;
}

}  // namespace trackbed::dem
