// Overlap volumes and centroids against exact rational arithmetic: CGAL intersects the half-spaces
// of both bodies (planes through the very vertices the kernel gets), random and degenerate pairs.
#include <gtest/gtest.h>

#include "tests/verification/exact_overlap.h"

namespace trackbed::dem::test {
namespace {

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
