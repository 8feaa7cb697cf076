#include "dem/surface/rigid.h"

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

}  // namespace trackbed::dem
