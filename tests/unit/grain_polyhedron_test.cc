// Hulls, mass properties, the principal frame: what they keep and what they refuse.
#include <gtest/gtest.h>

#include <limits>

#include "base/error.h"
#include "dem/grain/random.h"
#include "tests/unit/grain_solids.h"

namespace trackbed::dem {
namespace {

using namespace solids;

std::vector<Vec3> cube_points(int parts) {  // a lattice on and in the unit cube
  std::vector<Vec3> p;
  for (int i = 0; i <= parts; ++i)
    for (int j = 0; j <= parts; ++j)
      for (int k = 0; k <= parts; ++k) p.push_back(Vec3(i, j, k) / parts);
  return p;
}

TEST(ConvexHull, MergesCoplanarFacets) {
  for (int parts : {1, 2, 5}) {
    std::vector<Vec3> p = cube_points(parts);
    for (Vec3& v : p) v = any_turn * v + Vec3(3, -2, 7);
    const Polyhedron cube = convex_hull(p);
    EXPECT_EQ(cube.vertices.size(), 8u);
    EXPECT_EQ(cube.faces.size(), 6u);
    for (const auto& face : cube.faces) EXPECT_EQ(face.size(), 4u);
  }
}

TEST(ConvexHull, DuplicateAndNearlyCoplanarPointsChangeNothing) {
  const MassProperties exact = mass_properties(make_box({1, 1, 1}));
  for (double noise : {0.0, 1e-16, 1e-14, 1e-13}) {
    Random random(3);
    std::vector<Vec3> p;
    for (int copy = 0; copy < 3; ++copy)
      for (const Vec3& v : cube_points(2))
        p.push_back(v - Vec3(.5, .5, .5) + noise * random.direction());
    const Polyhedron cube = convex_hull(p);
    EXPECT_EQ(cube.vertices.size(), 8u) << noise;
    EXPECT_EQ(cube.faces.size(), 6u) << noise;
    const MassProperties m = mass_properties(cube);
    EXPECT_NEAR(m.volume, exact.volume, 1e-12);
    EXPECT_LT((m.inertia - exact.inertia).norm(), 1e-12);
  }
}

// Points that stand out of their plane by about the tolerance: merged or not, the surface is
// closed.
TEST(ConvexHull, NoiseAtTheToleranceKeepsTheSurfaceClosed) {
  Random random(5);
  for (double noise : {1e-11, 1e-10, 1e-9, 3e-9, 1e-8, 1e-7})
    for (int trial = 0; trial < 20; ++trial) {
      std::vector<Vec3> p = cube_points(3);
      for (Vec3& v : p) v += noise * random.direction();
      EXPECT_NEAR(mass_properties(convex_hull(p)).volume, 1, 20 * noise);
    }
}

TEST(ConvexHull, IsConvexAndHoldsItsPoints) {
  Random random(7);
  for (int trial = 0; trial < 50; ++trial) {
    std::vector<Vec3> p;
    for (int k = 0; k < 60; ++k) p.push_back(random.uniform() * random.direction());
    const Polyhedron hull = convex_hull(p);
    size_t half_edges = 0;
    for (const auto& face : hull.faces) {
      half_edges += face.size();
      const Vec3& a = hull.vertices[face[0]];
      const Vec3 n = (hull.vertices[face[1]] - a).cross(hull.vertices[face[2]] - a).normalized();
      for (const Vec3& q : p) EXPECT_LT(n.dot(q - a), 1e-8);
    }
    EXPECT_EQ(hull.vertices.size() + hull.faces.size(), half_edges / 2 + 2);  // Euler
  }
}

TEST(ConvexHull, RefusesFlatFewAndUnfinitePoints) {
  EXPECT_THROW(convex_hull({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}), InputError);
  EXPECT_THROW(convex_hull({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}), InputError);
  EXPECT_THROW(convex_hull({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 1e-12}}), InputError);
  EXPECT_THROW(convex_hull({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}), InputError);
  EXPECT_THROW(convex_hull({{1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}}), InputError);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(convex_hull({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, nan, 1}}), InputError);
}

TEST(MassProperties, RefusesWhatIsNoSolid) {
  Polyhedron open = make_box({1, 1, 1});
  open.faces.pop_back();
  EXPECT_THROW(mass_properties(open), InputError);
  Polyhedron inside_out = make_box({1, 1, 1});
  for (auto& face : inside_out.faces) std::reverse(face.begin(), face.end());
  EXPECT_THROW(mass_properties(inside_out), InputError);
  Polyhedron nan = make_box({1, 1, 1});
  nan.vertices[3].x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(mass_properties(nan), InputError);
  Polyhedron index = make_box({1, 1, 1});
  index.faces[0][0] = 8;
  EXPECT_THROW(mass_properties(index), InputError);
  EXPECT_THROW(mass_properties(Polyhedron{}), InputError);
  EXPECT_THROW(make_box({1, 0, 1}), InputError);
}

TEST(GrainShape, StandsInItsPrincipalFrameAndRemembersWhereItCameFrom) {
  const Polyhedron given = moved(make_box({3, 1, 2}), any_turn, {10, 20, 30});
  const GrainShape s = make_grain_shape(given);
  EXPECT_NEAR(s.volume, 6, 1e-12);
  EXPECT_NEAR(s.inertia[0], 6 * (1 + 4) / 12., 1e-11);
  EXPECT_NEAR(s.inertia[1], 6 * (1 + 9) / 12., 1e-11);
  EXPECT_NEAR(s.inertia[2], 6 * (4 + 9) / 12., 1e-11);
  EXPECT_NEAR(s.radius, std::sqrt(14.) / 2, 1e-12);
  for (size_t v = 0; v < given.vertices.size(); ++v)
    EXPECT_LT((s.origin + s.turn * s.body.vertices[v] - given.vertices[v]).norm(), 1e-12);
  const Mat3 inertia = mass_properties(s.body).inertia;
  EXPECT_LT((inertia - Mat3(s.inertia.asDiagonal())).norm(), 1e-11);
}

TEST(GrainShape, ScalesByPowersOfTheFactor) {
  const GrainShape s = make_grain_shape(make_box({3, 1, 2}));
  const GrainShape big = scaled(s, 2);
  EXPECT_DOUBLE_EQ(big.volume, 8 * s.volume);
  EXPECT_DOUBLE_EQ(big.inertia[1], 32 * s.inertia[1]);
  EXPECT_DOUBLE_EQ(big.radius, 2 * s.radius);
  EXPECT_NEAR(mass_properties(big.body).volume, big.volume, 1e-12);
  EXPECT_THROW(scaled(s, 0), InputError);
}

}  // namespace
}  // namespace trackbed::dem
