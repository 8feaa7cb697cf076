// Overlap volumes and centroids against exact rational arithmetic: CGAL intersects the half-spaces
// of both bodies (planes through the very vertices the kernel gets), random and degenerate pairs.
#include <CGAL/Convex_hull_3/dual/halfspace_intersection_with_constructions_3.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Polyhedron_3.h>
#include <gtest/gtest.h>

#include "tests/verification/contact_support.h"

namespace trackbed::dem::test {
namespace {

using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Point = Kernel::Point_3;
using Plane = Kernel::Plane_3;

// The place of a body is exact here: a shift, or a turn whose products are exact (multiples of 1/8
// and quarter turns), so that both sides see the same solids. Random hulls have triangles only.
std::vector<Plane> planes(const Polyhedron& body, const Pose& pose) {
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

Exact exact_overlap(std::vector<Plane> all, const Vec3& inside) {
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

// Compares for several axes; true if the pair overlaps.
bool compare(const Polyhedron& a, const Pose& pa, const Polyhedron& b, const Pose& pb,
             Random& random, double tolerance) {
  ShapeTable table;
  table.add(as_is(a)), table.add(as_is(b));
  Vec3 axis = Vec3::Zero();
  if (separating_axis(table.view(0), pa, table.view(1), pb, axis) > 0) return false;
  const Contact first = evaluate(table.view(0), pa, table.view(1), pb, axis);
  if (!first.touching) return false;
  std::vector<Plane> all = planes(a, pa), more = planes(b, pb);
  all.insert(all.end(), more.begin(), more.end());
  const Exact exact = exact_overlap(all, first.centroid);
  const double size = std::cbrt(exact.volume);
  for (int k = 0; k < 4; ++k) {
    const Contact c =
        evaluate(table.view(0), pa, table.view(1), pb, k == 0 ? axis : random.direction());
    EXPECT_NEAR(c.volume, exact.volume, tolerance * exact.volume) << a.vertices.size();
    EXPECT_LT((c.centroid - exact.centroid).norm(), tolerance * size);
  }
  return true;
}

TEST(ExactOverlap, RandomHulls) {
  Random random(21);
  int overlapping = 0;
  for (int k = 0; k < 150; ++k) {
    const Polyhedron a = random_hull(random, 6 + k % 15), b = random_hull(random, 6 + k % 11);
    const Pose pa{Mat3::Identity(), Vec3::Zero()},
        pb{Mat3::Identity(), random.uniform(0, 1.6) * random.direction()};
    overlapping += compare(a, pa, b, pb, random, 1e-10);
  }
  EXPECT_GT(overlapping, 80);
}

TEST(ExactOverlap, ShallowRandomHulls) {
  Random random(22);
  for (int k = 0; k < 100; ++k) {
    const Polyhedron a = random_hull(random, 6 + k % 15), b = random_hull(random, 6 + k % 11);
    ShapeTable table;
    table.add(as_is(a)), table.add(as_is(b));
    const Pose pa{Mat3::Identity(), Vec3::Zero()};
    // Turn b's vertices first, so that its pose is a shift.
    Pose pb = touching_pose(random, table.view(0), pa, table.view(1), 0);
    Polyhedron turned = b;
    for (Vec3& v : turned.vertices) v = pb.R * v;
    pb.R = Mat3::Identity();
    pb.x *= 1 - std::pow(10, random.uniform(-4, -2));
    compare(a, pa, turned, pb, random, 1e-10);
  }
}

// Bodies on the lattice of 1/8: coplanar faces, common edges and vertices, edges crossing edges.
TEST(ExactOverlap, LatticeBodies) {
  Random random(23);
  const auto lattice = [&random](int range) { return double(random.below(2 * range + 1)) - range; };
  int overlapping = 0;
  for (int k = 0; k < 300; ++k) {
    const auto body = [&] {
      while (true) {
        std::vector<Vec3> points;
        for (int i = 0; i < 9; ++i) points.push_back(Vec3(lattice(2), lattice(2), lattice(2)) / 8);
        try {
          return convex_hull(points);
        } catch (const std::exception&) {
        }
      }
    };
    const Polyhedron a = body(), b = k % 10 == 0 ? a : body();
    const Pose pa{Mat3::Identity(), Vec3::Zero()};
    Pose pb{Mat3::Identity(), Vec3(lattice(2), lattice(2), lattice(2)) / 8};
    if (k % 10 == 0 && k % 20 == 0) pb.x.setZero();
    if (k % 3 == 0) pb.R << 0, -1, 0, 1, 0, 0, 0, 0, 1;
    overlapping += compare(a, pa, b, pb, random, 1e-10);
  }
  EXPECT_GT(overlapping, 150);
}

}  // namespace
}  // namespace trackbed::dem::test
