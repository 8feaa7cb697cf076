// The overlap of two convex polyhedra in exact rational arithmetic: CGAL intersects the half-spaces
// of both bodies (planes through the very vertices the kernel gets).
#pragma once
#include <CGAL/Convex_hull_3/dual/halfspace_intersection_with_constructions_3.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Polyhedron_3.h>

#include "tests/verification/contact_support.h"

namespace trackbed::dem::test {

using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Point = Kernel::Point_3;
using Plane = Kernel::Plane_3;

// The place of a body is exact here: a shift, or a turn whose products are exact (multiples of 1/8
// and quarter turns), so that both sides see the same solids. Random hulls have triangles only.
inline std::vector<Plane> planes(const Polyhedron& body, const Pose& pose) {
  std::vector<Point> p;
  for (const Vec3& v : body.vertices) {
    const Vec3 turned = pose.R * v;
    p.emplace_back(Kernel::FT(turned.x()) + Kernel::FT(pose.x.x()),
                   Kernel::FT(turned.y()) + Kernel::FT(pose.x.y()),
                   Kernel::FT(turned.z()) + Kernel::FT(pose.x.z()));
  }
  std::vector<Plane> out;
  for (const auto& f : body.faces) out.emplace_back(p[f[0]], p[f[1]], p[f[2]]);
  return out;
}

struct Exact {
  double volume;
  Vec3 centroid;
};

/// volume -1 when `inside` is not strictly inside of all planes.
inline Exact exact_overlap(std::vector<Plane> all, const Vec3& inside) {
  CGAL::Polyhedron_3<Kernel> solid;
  const Point o(inside.x(), inside.y(), inside.z());
  for (const Plane& plane : all)
    if (!plane.has_on_negative_side(o)) return {-1, Vec3::Zero()};
  CGAL::halfspace_intersection_with_constructions_3(all.begin(), all.end(), solid, o);
  Kernel::FT volume = 0, first[3] = {0, 0, 0};
  for (auto f = solid.facets_begin(); f != solid.facets_end(); ++f) {
    auto h = f->facet_begin();
    const auto a = h->vertex()->point() - o;
    auto b = (++h)->vertex()->point() - o;
    for (++h; h != f->facet_begin(); ++h) {
      const auto c = h->vertex()->point() - o;
      const Kernel::FT six = CGAL::determinant(a, b, c);
      volume += six;
      for (int i = 0; i < 3; ++i) first[i] += six * (a[i] + b[i] + c[i]);
      b = c;
    }
  }
  Exact e;
  e.volume = CGAL::to_double(volume / 6);
  for (int i = 0; i < 3; ++i) e.centroid(i) = inside(i) + CGAL::to_double(first[i] / (4 * volume));
  return e;
}

}  // namespace trackbed::dem::test
