// Voronoi cells fill their box; generators and libraries repeat by seed; knobs do what they say.
#include <gtest/gtest.h>

#include "base/error.h"
#include "dem/grain/library.h"
#include "dem/grain/random.h"
#include "dem/grain/shape_indices.h"
#include "dem/grain/voronoi.h"

namespace trackbed::dem {
namespace {

TEST(Voronoi, CellsFillThePeriodicBox) {
  for (int count : {1, 2, 30, 300}) {
    VoronoiParameters p;
    p.count = count;
    p.least_face = 0;
    double volume = 0;
    for (const Polyhedron& cell : voronoi_grains(p)) volume += mass_properties(cell).volume;
    EXPECT_NEAR(volume, count, 1e-9 * count) << count;
  }
}

TEST(Voronoi, GrainsAreBallastLike) {
  VoronoiParameters p;
  p.count = 300;
  double faces = 0, vertices = 0;
  for (const Polyhedron& cell : voronoi_grains(p)) {
    faces += cell.faces.size() / 300.;
    vertices += cell.vertices.size() / 300.;
    double least = 1e300, total = 0;
    for (const auto& face : cell.faces) {
      Vec3 twice = Vec3::Zero();
      for (size_t k = 0; k < face.size(); ++k)
        twice += cell.vertices[face[k]].cross(cell.vertices[face[(k + 1) % face.size()]]);
      least = std::min(least, twice.norm() / 2);
      total += twice.norm() / 2;
    }
    EXPECT_GT(least, 1e-3 * total / cell.faces.size());
  }
  EXPECT_GT(faces, 10);
  EXPECT_LT(faces, 20);
  EXPECT_GT(vertices, 14);
  EXPECT_LT(vertices, 26);
}

void expect_same(const std::vector<Polyhedron>& a, const std::vector<Polyhedron>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].faces, b[i].faces);
    ASSERT_EQ(a[i].vertices.size(), b[i].vertices.size());
    for (size_t v = 0; v < a[i].vertices.size(); ++v) EXPECT_EQ(a[i].vertices[v], b[i].vertices[v]);
  }
}

TEST(Generators, RepeatBySeed) {
  VoronoiParameters v;
  v.count = 40;
  expect_same(voronoi_grains(v), voronoi_grains(v));
  VoronoiParameters other = v;
  other.seed = 2;
  EXPECT_NE(voronoi_grains(v)[0].vertices[0], voronoi_grains(other)[0].vertices[0]);
  EllipsoidParameters e;
  e.count = 40;
  expect_same(ellipsoid_grains(e), ellipsoid_grains(e));
}

// mt19937_64 seeded with 5489 gives 9981545732273789042 as its 10000th number (the C++ standard).
TEST(Random, BitsAreTheStandards) {
  Random random(5489);
  for (int k = 1; k < 10000; ++k) random.uniform();
  EXPECT_EQ(random.uniform(), double(9981545732273789042ull >> 11) * 0x1p-53);
}

TEST(Library, ShapesAreSizedToOneAndProgressEnds) {
  for (const char* generator : {"voronoi", "ellipsoid", "jin_hull"}) {
    LibraryParameters p;
    p.generator = generator;
    p.count = 20;
    double last = 0;
    const auto library = make_library(p, [&](double share) { last = share; });
    ASSERT_EQ(library.size(), 20u);
    EXPECT_DOUBLE_EQ(last, 1);
    for (const GrainShape& s : library) {
      EXPECT_EQ(s.sieve_size, 1);
      EXPECT_NEAR(sieve_size(s.body), 1, 1e-6);
      EXPECT_NEAR(mass_properties(s.body).volume, s.volume, 1e-12);
      EXPECT_LT(mass_properties(s.body).centroid.norm(), 1e-12);
    }
    const auto again = make_library(p);
    for (size_t i = 0; i < library.size(); ++i) EXPECT_EQ(library[i].inertia, again[i].inertia);
  }
}

TEST(Library, ElongationAndFlatnessAreMeans) {
  LibraryParameters p;
  p.count = 100;
  p.elongation = 0.6;
  p.flatness = 0.5;
  p.method = SieveMethod::equal_cube;
  double elongation = 0, flatness = 0;
  for (const GrainShape& s : make_library(p)) {
    const ShapeIndices i = shape_indices(s.body);
    elongation += i.elongation / 100;
    flatness += i.flatness / 100;
  }
  EXPECT_NEAR(elongation, 0.6, 0.06);
  EXPECT_NEAR(flatness, 0.5, 0.06);
}

TEST(Library, RefusesWrongRequests) {
  LibraryParameters p;
  p.generator = "voronoy";
  try {
    make_library(p);
    FAIL();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("'voronoi'"), std::string::npos) << e.what();
  }
  p = {};
  p.count = 0;
  EXPECT_THROW(make_library(p), InputError);
  p = {};
  p.count = 2;
  p.flatness = 1.5;
  EXPECT_THROW(make_library(p), InputError);
  VoronoiParameters v;
  v.spacing = 0.9;
  EXPECT_THROW(voronoi_grains(v), InputError);
  EXPECT_THROW(intersect_half_spaces({Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ(), -Vec3::UnitX()},
                                     {1, 1, 1, 1}),
               InputError);
}

}  // namespace
}  // namespace trackbed::dem
