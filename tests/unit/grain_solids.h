// Solids with known properties, for the tests of grains and sieve sizes.
#pragma once
#include <cmath>
#include <vector>

#include "dem/grain/polyhedron.h"

namespace trackbed::dem::solids {

inline Polyhedron tetrahedron() {  // edge 1
  const double a = 1 / std::sqrt(8.0);
  return convex_hull({{a, a, a}, {a, -a, -a}, {-a, a, -a}, {-a, -a, a}});
}
inline Polyhedron octahedron() {  // edge 1
  const double a = std::sqrt(0.5);
  return convex_hull({{a, 0, 0}, {-a, 0, 0}, {0, a, 0}, {0, -a, 0}, {0, 0, a}, {0, 0, -a}});
}
inline Polyhedron icosahedron() {  // edge 1
  const double f = 0.25 * (1 + std::sqrt(5.0)), h = 0.5;
  std::vector<Vec3> p;
  for (double s : {-h, h})
    for (double t : {-f, f}) {
      p.emplace_back(0, s, t);
      p.emplace_back(s, t, 0);
      p.emplace_back(t, 0, s);
    }
  return convex_hull(p);
}
inline Polyhedron bipyramid(double height) {  // triangular, equator radius 1
  const double s = std::sqrt(0.75);
  return convex_hull({{1, 0, 0}, {-0.5, s, 0}, {-0.5, -s, 0}, {0, 0, height}, {0, 0, -height}});
}
inline Polyhedron moved(Polyhedron body, const Quat& turn, const Vec3& shift, double scale = 1) {
  for (Vec3& v : body.vertices) v = scale * (turn * v) + shift;
  return body;
}
inline const Quat any_turn = Quat(0.3, -0.5, 0.7, 0.2).normalized();

}  // namespace trackbed::dem::solids
