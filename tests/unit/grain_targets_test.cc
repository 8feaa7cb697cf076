// A library meets the targets asked for, says what it cannot reach, and reports what it is like.
#include <gtest/gtest.h>

#include "base/error.h"
#include "dem/grading/rounded_sieve_size.h"
#include "dem/grain/library.h"
#include "dem/grain/library_report.h"
#include "dem/grain/shape_targets.h"
#include "tests/unit/grain_solids.h"

namespace trackbed::dem {
namespace {

using namespace solids;

LibraryParameters quick(const std::string& generator) {
  LibraryParameters p;
  p.generator = generator;
  p.count = 100;
  p.method = SieveMethod::equal_cube;
  return p;
}

TEST(ShapeTargets, SphericityIsTheMean) {
  for (const char* generator : {"voronoi", "ellipsoid", "jin_hull"})
    for (double target : {0.6, 0.75}) {
      LibraryParameters p = quick(generator);
      p.sphericity = target;
      EXPECT_NEAR(library_report(make_library(p)).sphericity.mean, target, 1e-6) << generator;
    }
}

TEST(ShapeTargets, AngularityIsNearlyTheMean) {
  LibraryParameters p = quick("voronoi");
  const double as_generated = library_report(make_library(p)).angularity.mean;
  for (double target : {0.45, 0.55, 0.65}) {
    p.angularity = target;
    const LibraryReport r = library_report(make_library(p));
    EXPECT_NEAR(r.angularity.mean, target, 0.01);
    EXPECT_LT(r.angularity.mean, as_generated);
  }
  p.angularity = 0.5, p.elongation = 0.7, p.flatness = 0.6;
  const LibraryReport r = library_report(make_library(p));
  EXPECT_NEAR(r.angularity.mean, 0.5, 0.01);
  EXPECT_NEAR(r.elongation.mean, 0.7, 0.05);
  EXPECT_NEAR(r.flatness.mean, 0.6, 0.05);
}

// All twelve edges of a cube of edge 2 cut off: the volume follows from the prisms.
TEST(Blunted, Cube) {
  const Polyhedron cube = make_box({2, 2, 2});
  EXPECT_EQ(blunted(cube, 0).faces.size(), 6u);
  const Polyhedron body = blunted(cube, 1, 0.1);
  EXPECT_EQ(body.faces.size(), 18u);
  // Legs of the prism: 2 d; prisms overlap at the corners: integral over the third octant.
  const double e = 0.2;
  const double prisms = 12 * 2 * e * e / 2;
  // In a corner cube of edge e (coordinates from the corner): removed where some two sum below e.
  // Three prisms counted e^3/2 each; union: 1 - P(no pair sums below 1) = 1 - 1/4.
  const double corners = 8 * e * e * e * (0.75 - 1.5);
  EXPECT_NEAR(mass_properties(body).volume, 8 - prisms - corners, 1e-9);
  EXPECT_LT(shape_indices(body).angularity, 0.6);
  EXPECT_EQ(blunted(cube, 0.25, 0.1).faces.size(), 9u);
}

TEST(ShapeTargets, NeedlesAndFlakes) {
  LibraryParameters p = quick("voronoi");
  p.count = 20;
  p.method = SieveMethod::exact;
  p.needles = 6, p.flakes = 5;
  const auto shapes = make_library(p);
  int needles = 0, flakes = 0;
  for (const GrainShape& s : shapes) {
    EXPECT_NEAR(sieve_size(s.body), 1, 1e-6);
    const ShapeIndices i = shape_indices(s.body);
    needles += i.diameter > 1.8;
    flakes += i.width < 0.6;
  }
  EXPECT_GE(needles, 6);
  EXPECT_LE(needles, 8);
  EXPECT_GE(flakes, 5);
  EXPECT_LE(flakes, 7);
  p.needles = 18;
  EXPECT_THROW(make_library(p), InputError);
}

void refused(const LibraryParameters& p, const std::string& part) {
  try {
    make_library(p);
    ADD_FAILURE() << "accepted; expected: " << part;
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find(part), std::string::npos) << e.what();
  }
}

TEST(ShapeTargets, OutOfReachIsNamed) {
  LibraryParameters p = quick("voronoi");
  p.sphericity = 0.95;
  refused(p, "mean sphericity 0.95 is out of reach; these shapes reach");
  p.sphericity = 0.7, p.flatness = 0.5;
  refused(p, "cannot be given together");
  p = quick("ellipsoid");
  p.angularity = 0.9;
  refused(p, "mean angularity 0.9 is out of reach; these shapes reach");
  p.angularity = std::nan("");
  refused(p, "angularity must be positive");
}

TEST(LibraryReport, OfBoxes) {
  std::vector<GrainShape> shapes;
  for (const Vec3& e : {Vec3(1, 1, 1), Vec3(1, 1, 2)}) {
    shapes.push_back(make_grain_shape(make_box(e)));
    shapes.back().sieve_size = 1;
  }
  const LibraryReport r = library_report(shapes);
  EXPECT_EQ(r.shapes, 2);
  EXPECT_NEAR(r.elongation.mean, 0.75, 1e-12);
  EXPECT_NEAR(r.elongation.deviation, 0.5 / std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(r.elongation.least, 0.5, 1e-12);
  EXPECT_NEAR(r.elongation.largest, 1, 1e-12);
  EXPECT_NEAR(r.faces.mean, 6, 1e-12);
  EXPECT_NEAR(r.solidity.mean, 1.5, 1e-12);
  EXPECT_NEAR(r.angularity.mean, 1, 1e-12);
  EXPECT_NEAR(r.indices.elongated, 100 * 2 / 3., 1e-9);
  const std::string csv = to_csv(r);
  EXPECT_EQ(csv.substr(0, csv.find('\n')), "index,mean,deviation,least,largest");
  EXPECT_NE(csv.find("elongation_index_percent,66.6667,,,"), std::string::npos) << csv;
}

TEST(ClumpLibrary, ClumpsOfSieveSizeOne) {
  LibraryParameters p;
  p.count = 8;
  const auto clumps = make_clump_library(p);
  ASSERT_EQ(clumps.size(), 8u);
  for (const ClumpShape& c : clumps) {
    EXPECT_NEAR(sieve_size(c.spheres), 1, 1e-5);
    EXPECT_GT(c.spheres.size(), 15u);
    EXPECT_NEAR(mass_properties(c.spheres).volume, c.volume, 1e-12);
  }
}

}  // namespace
}  // namespace trackbed::dem
