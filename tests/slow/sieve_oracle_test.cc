// Exact sieve sizes against brute force on hundreds of shapes of every generator, needles, flakes
// and symmetric solids among them.
#include "tests/verification/sieve_oracle.h"

#include <gtest/gtest.h>

#include "dem/grading/sieve_size.h"
#include "dem/grain/library.h"
#include "tests/unit/grain_solids.h"

namespace trackbed::dem {
namespace {

void agrees(const std::vector<Polyhedron>& bodies) {
#pragma omp parallel for schedule(dynamic)
  for (int k = 0; k < int(bodies.size()); ++k) {
    const ExactSieveSize s = exact_sieve_size(bodies[k]);
    double found = brute_force(bodies[k], 500 + k);
    // A random search may end in a dent beside the least one: it gets some more tries.
    for (int more = 1; more < 5 && found > s.size * (1 + 1e-6); ++more)
      found = std::min(found, brute_force(bodies[k], 500 + k + 10000 * more));
    EXPECT_GE(found, s.lower_bound * (1 - 1e-12)) << k;  // nothing below the bound
    EXPECT_LE(s.size, found * (1 + 2.5e-7)) << k;        // nothing better found
    EXPECT_GE(s.lower_bound, s.size * (1 - 1e-6)) << k;  // certified
    EXPECT_NEAR(found / s.size, 1, 1e-6) << k;
  }
}

class Oracle : public testing::TestWithParam<const char*> {};

TEST_P(Oracle, LibraryOf) {
  LibraryParameters p;
  p.generator = GetParam(), p.count = 100, p.seed = 21;
  p.needles = p.flakes = 15;
  p.method = SieveMethod::equal_cube;
  std::vector<Polyhedron> bodies;
  for (const GrainShape& shape : make_library(p)) bodies.push_back(shape.body);
  agrees(bodies);
}
INSTANTIATE_TEST_SUITE_P(Generators, Oracle, testing::Values("voronoi", "ellipsoid", "jin_hull"));

TEST(Oracle, SymmetricSolids) {
  using namespace solids;
  Random random(5);
  std::vector<Polyhedron> bodies;
  for (const Polyhedron& body : {tetrahedron(), octahedron(), icosahedron(), bipyramid(1),
                                 bipyramid(3), make_box({1, 1, 1}), make_box({64, 4, 100})})
    for (int turn = 0; turn < 4; ++turn)
      bodies.push_back(moved(
          body, Quat(Eigen::AngleAxisd(3 * random.uniform(), random.direction())), {1, 2, 3}));
  agrees(bodies);
}

}  // namespace
}  // namespace trackbed::dem
