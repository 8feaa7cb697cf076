#include "dem/surface/rigid.h"

#include <cmath>

#include "base/error.h"

namespace trackbed::dem {

int add_grain(Bodies& b, const ShapeTable& shapes, int shape, int material, double density,
              const Vec3& x, const Quat& q, std::uint8_t freedom) {
  if (b.grains != b.size()) throw InputError("grains must be added before rigid bodies");
  const GrainShape& s = shapes.shape(shape);
  const int i =
      add_body(b, shape, material, density * s.volume, density * s.inertia, x, q, freedom);
  b.grains = b.size();
  return i;
}

int add_rigid_body(Bodies& b, ShapeTable& shapes, const Polyhedron& body, int material, double mass,
                   const Vec3& place, const Quat& turn, std::uint8_t freedom) {
  const GrainShape s = make_grain_shape(body);
  const int shape = shapes.add(s);
  const double density = mass / s.volume;
  return add_body(b, shape, material, mass, density * s.inertia, place + turn * s.origin,
                  turn * s.turn, freedom);
}

int add_box(Bodies& b, ShapeTable& shapes, const Vec3& low, const Vec3& high, int material,
            double mass, std::uint8_t freedom) {
  return add_rigid_body(b, shapes, make_box(high - low), material, mass, (low + high) / 2,
                        Quat::Identity(), freedom);
}

std::vector<int> add_container(Bodies& b, ShapeTable& shapes, const Vec3& low, const Vec3& high,
                               double thickness, int material, unsigned sides) {
  std::vector<int> walls;
  for (int side = 0; side < 6; ++side) {
    if (!(sides >> side & 1)) continue;
    const int d = side / 2;
    Vec3 from = low - Vec3::Constant(thickness), to = high + Vec3::Constant(thickness);
    if (side % 2 == 0)
      to[d] = low[d];
    else
      from[d] = high[d];
    walls.push_back(add_box(b, shapes, from, to, material, 1, kFixed));  // held: mass is no matter
  }
  return walls;
}

double prism_apothem(double radius, int sides) {
  return radius * std::sqrt(M_PI / (sides * std::tan(M_PI / sides)));
}

Polyhedron make_round_prism(double radius, double height, int sides) {
  const double corner = prism_apothem(radius, sides) / std::cos(M_PI / sides);
  std::vector<Vec3> points;
  for (int k = 0; k < sides; ++k) {
    const double angle = 2 * M_PI * (k + 0.5) / sides;
    for (const double z : {0.0, height})
      points.emplace_back(corner * std::cos(angle), corner * std::sin(angle), z);
  }
  return convex_hull(points);
}

std::vector<int> add_round_wall(Bodies& b, ShapeTable& shapes, const Vec3& centre, double radius,
                                double low, double high, double thickness, int material,
                                int sides) {
  if (sides < 8) throw InputError("a round wall needs at least 8 sides");
  const double inner = prism_apothem(radius, sides), outer = inner + thickness;
  const double slope = std::tan(M_PI / sides);
  std::vector<Vec3> points;  // of the side that faces along x
  for (const double r : {inner, outer})
    for (const double side : {-1.0, 1.0})
      for (const double z : {low, high}) points.emplace_back(r, side * r * slope, z);
  const Polyhedron block = convex_hull(points);
  std::vector<int> walls;
  for (int k = 0; k < sides; ++k) {
    const Quat turn(Eigen::AngleAxisd(2 * M_PI * k / sides, Vec3::UnitZ()));
    walls.push_back(add_rigid_body(b, shapes, block, material, 1, Vec3(centre.x(), centre.y(), 0),
                                   turn, kFixed));
  }
  return walls;
}

}  // namespace trackbed::dem
