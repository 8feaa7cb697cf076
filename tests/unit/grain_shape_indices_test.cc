#include <gtest/gtest.h>

#include "base/error.h"
#include "dem/grain/polyhedron.h"
#include "dem/grain/random.h"
#include "dem/grain/shape_indices.h"
#include "tests/unit/grain_solids.h"

namespace trackbed::dem {
namespace {

using namespace solids;

TEST(ShapeIndices, Box) {
  const ShapeIndices s = shape_indices(moved(make_box({64, 30, 100}), any_turn, {1, 2, 3}));
  EXPECT_NEAR(s.length, 100, 1e-9);
  EXPECT_NEAR(s.intermediate, 64, 1e-9);
  EXPECT_NEAR(s.shortest, 30, 1e-9);
  EXPECT_NEAR(s.elongation, 0.64, 1e-12);
  EXPECT_NEAR(s.flatness, 30 / 64., 1e-12);
  EXPECT_NEAR(s.width, 30, 1e-9);
  EXPECT_NEAR(s.diameter, std::sqrt(64. * 64 + 30 * 30 + 100 * 100), 1e-9);
  EXPECT_NEAR(s.surface, 2 * (64 * 30 + 64 * 100 + 30 * 100), 1e-8);
  EXPECT_NEAR(s.angularity, 1, 1e-12);
}

TEST(ShapeIndices, RegularSolids) {
  EXPECT_NEAR(shape_indices(make_box({1, 1, 1})).sphericity, std::cbrt(M_PI / 6), 1e-12);
  const ShapeIndices t = shape_indices(tetrahedron());
  EXPECT_NEAR(t.width, std::sqrt(0.5), 1e-12);  // edge on edge, less than the height sqrt(2/3)
  EXPECT_NEAR(t.angularity, (M_PI - std::acos(1 / 3.)) / (M_PI / 2), 1e-12);
  EXPECT_NEAR(shape_indices(octahedron()).width, std::sqrt(2 / 3.), 1e-12);  // face on face
  EXPECT_NEAR(shape_indices(icosahedron()).sphericity, 0.939, 5e-4);
}

// Among all directions across two of the segments between corners, edges or not, and those of faces.
TEST(ShapeIndices, WidthIsTheLeastOfAllDirections) {
  Random random(2);
  for (int k = 0; k < 40; ++k) {
    std::vector<Vec3> points;
    for (int i = 0; i < 6 + k % 5; ++i)
      points.push_back(random.uniform(.6, 1) * random.direction());
    const Polyhedron body = moved(convex_hull(points), any_turn, {1, 2, 3});
    const auto& v = body.vertices;
    std::vector<Vec3> segments, directions;
    for (std::size_t i = 0; i < v.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) segments.push_back(v[i] - v[j]);
    for (std::size_t i = 0; i < segments.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) directions.push_back(segments[i].cross(segments[j]));
    double least = 10;
    for (const Vec3& d : directions) {
      if (d.norm() < 1e-9) continue;
      double low = 100, high = -100;
      for (const Vec3& x : v)
        low = std::min(low, x.dot(d) / d.norm()), high = std::max(high, x.dot(d) / d.norm());
      least = std::min(least, high - low);
    }
    EXPECT_NEAR(shape_indices(body).width, least, 1e-12) << k;
  }
}

TEST(LibraryIndices, SharesOfVolume) {
  std::vector<GrainShape> shapes;
  for (const Vec3& e : {Vec3(1, 1, 1), Vec3(1, 0.5, 1), Vec3(1, 1, 2), Vec3(1, 0.3, 1)}) {
    shapes.push_back(make_grain_shape(make_box(e)));
    shapes.back().sieve_size = 1;
  }
  std::vector<ShapeIndices> indices;
  for (const GrainShape& s : shapes) indices.push_back(shape_indices(s.body));
  const LibraryIndices r = library_indices(shapes, indices);
  const double total = 1 + 0.5 + 2 + 0.3;
  EXPECT_NEAR(r.flaky, 100 * 0.8 / total, 1e-9);
  EXPECT_NEAR(r.elongated, 100 * 2 / total, 1e-9);
  EXPECT_NEAR(r.slender, 100 * 0.3 / total, 1e-9);
  shapes[0].sieve_size = 0;
  EXPECT_THROW(library_indices(shapes, indices), InputError);
  EXPECT_THROW(library_indices({}, {}), InputError);
}

}  // namespace
}  // namespace trackbed::dem
