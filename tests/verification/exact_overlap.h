// The overlap of two convex polyhedra in exact rational arithmetic: CGAL intersects the half-spaces
// of both bodies (planes through the very vertices the kernel gets).
#pragma once
#include <CGAL/Convex_hull_3/dual/halfspace_intersection_with_constructions_3.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Polyhedron_3.h>

#include <array>

#include "tests/verification/contact_support.h"

namespace trackbed::dem::test {

using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Point = Kernel::Point_3;
using Plane = Kernel::Plane_3;

// Three corners of a face, in its order, that fix its plane best: neighbours may almost coincide.
inline std::array<int, 3> largest_triangle(const Polyhedron& body, const std::vector<int>& face) {
  std::array<int, 3> best{face[0], face[1], face[2]};
  double most = -1;
  for (std::size_t i = 0; i < face.size(); ++i)
    for (std::size_t j = i + 1; j < face.size(); ++j)
      for (std::size_t k = j + 1; k < face.size(); ++k) {
        const Vec3& p = body.vertices[face[i]];
        const double twice = (body.vertices[face[j]] - p).cross(body.vertices[face[k]] - p).norm();
        if (twice > most) most = twice, best = {face[i], face[j], face[k]};
      }
  return best;
}

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
  for (const auto& f : body.faces) {
    const std::array<int, 3> corner = largest_triangle(body, f);
    out.emplace_back(p[corner[0]], p[corner[1]], p[corner[2]]);
  }
  return out;
}

struct Exact {
  double volume;
  Vec3 centroid;
  Mat3 second = Mat3::Zero();  ///< int (x-c)(x-c)^T dV, c the centroid [m5]
};

/// volume -1 when `inside` is not strictly inside of all planes.
inline Exact exact_overlap(std::vector<Plane> all, const Vec3& inside) {
  CGAL::Polyhedron_3<Kernel> solid;
  const Point o(inside.x(), inside.y(), inside.z());
  for (const Plane& plane : all)
    if (!plane.has_on_negative_side(o)) return {-1, Vec3::Zero(), Mat3::Zero()};
  CGAL::halfspace_intersection_with_constructions_3(all.begin(), all.end(), solid, o);
  // Of a lazy number to_double() is true to 1e-5 only, unless it is asked for its exact value.
  const auto value = [](const Kernel::FT& x) { return CGAL::to_double(CGAL::exact(x)); };
  const auto vec = [&](const Kernel::Vector_3& v) {
    return Vec3(value(v[0]), value(v[1]), value(v[2]));
  };
  Kernel::FT volume = 0, first[3] = {0, 0, 0};
  Mat3 second = Mat3::Zero();  // about `inside`; all its parts are positive
  for (auto f = solid.facets_begin(); f != solid.facets_end(); ++f) {
    auto h = f->facet_begin();
    const auto a = h->vertex()->point() - o;
    auto b = (++h)->vertex()->point() - o;
    for (++h; h != f->facet_begin(); ++h) {
      const auto c = h->vertex()->point() - o;
      const Kernel::FT six = CGAL::determinant(a, b, c);
      volume += six;
      for (int i = 0; i < 3; ++i) first[i] += six * (a[i] + b[i] + c[i]);
      const Vec3 p = vec(a), q = vec(b), r = vec(c), sum = p + q + r;
      second += value(six) / 120 *
                (p * p.transpose() + q * q.transpose() + r * r.transpose() + sum * sum.transpose());
      b = c;
    }
  }
  Exact e;
  e.volume = value(volume / 6);
  Vec3 way;  // to the centroid
  for (int i = 0; i < 3; ++i) way(i) = value(first[i] / (4 * volume));
  e.centroid = inside + way;
  e.second = second - e.volume * way * way.transpose();
  return e;
}

}  // namespace trackbed::dem::test
