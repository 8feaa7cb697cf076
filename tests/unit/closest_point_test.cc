// The nearest point of a convex polyhedron, by what makes it one: it lies in the body, and no corner
// lies beyond the plane through it across the way to it (the projection's variational inequality).
#include "dem/contact/closest_point.h"

#include <gtest/gtest.h>

#include <random>

#include "dem/grain/voronoi.h"

namespace trackbed::dem {
namespace {

double highest(const ConvexView& v, const Vec3& p) {
  double most = -HUGE_VAL;
  for (int f = 0; f < v.faces; ++f)
    most = std::max(most, Vec3(v.nx[f], v.ny[f], v.nz[f]).dot(p) - v.offset[f]);
  return most;
}

// Returns the dimension of what the point lies on.
int expect_nearest(const ConvexView& v, const Vec3& p) {
  const ClosestPoint c = closest_point(v, p);
  for (int likely = 0; likely < v.faces; ++likely) {
    const ClosestPoint again = closest_point(v, p, likely);
    EXPECT_LT((again.point - c.point).norm(), 1e-14 * (v.radius + p.norm()));
  }
  const double size = v.radius + p.norm();
  const Vec3 n(v.nx[c.face], v.ny[c.face], v.nz[c.face]);
  EXPECT_NEAR(n.dot(c.point), v.offset[c.face], 1e-14 * size);
  if (c.dimension == 3) {
    EXPECT_LE(highest(v, p), 0);
    EXPECT_NEAR((c.point - p).norm(), -highest(v, p), 1e-14 * size);
    return 3;
  }
  const Vec3 way = p - c.point;
  EXPECT_LE(highest(v, c.point), 1e-14 * size);
  for (int k = 0; k < v.vertices; ++k)
    EXPECT_LE(way.dot(Vec3(v.x[k], v.y[k], v.z[k]) - c.point), 1e-14 * size * size);
  if (c.dimension == 2) {
    EXPECT_LT(way.cross(n).norm(), 1e-14 * size);
  }
  return c.dimension;
}

TEST(ClosestPoint, is_the_projection_on_grains_and_boxes) {
  ShapeTable table;
  VoronoiParameters parameters;
  parameters.count = 30;
  table.add(make_grain_shape(make_box({1, 2, 3})));  // fewer than eight planes
  for (const Polyhedron& body : voronoi_grains(parameters)) table.add(make_grain_shape(body));
  std::mt19937 random(5);
  const auto u = [&] { return random() / 2147483648. - 1; };
  int of_dimension[4] = {0, 0, 0, 0}, many_faces = 0;
  for (int s = 0; s < table.size(); ++s) {
    const ConvexView& view = table.view(s);
    many_faces += view.faces > 8;
    for (int k = 0; k < 1000; ++k)
      ++of_dimension[expect_nearest(view, 1.2 * view.radius * Vec3(u(), u(), u()))];
    for (int f = 0; f < view.faces; ++f) {  // above a face, and where two meet
      const int i = view.loop[view.loop_begin[f]], j = view.loop[view.loop_begin[f] + 1];
      const Vec3 edge =
          (Vec3(view.x[i], view.y[i], view.z[i]) + Vec3(view.x[j], view.y[j], view.z[j])) / 2;
      expect_nearest(view, edge + .1 * view.radius * Vec3(view.nx[f], view.ny[f], view.nz[f]));
    }
  }
  for (const int n : of_dimension) EXPECT_GT(n, 500);
  EXPECT_GT(many_faces, 20);
}

}  // namespace
}  // namespace trackbed::dem
