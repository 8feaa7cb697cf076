// Sieve sizes of clumps and dilated grains: known ones, and a brute-force search.
#include <gtest/gtest.h>

#include <algorithm>

#include "base/error.h"
#include "dem/grading/disc_hull.h"
#include "dem/grading/rounded_sieve_size.h"
#include "dem/grain/clump.h"
#include "dem/grain/jin.h"
#include "dem/grain/random.h"
#include "dem/grain/voronoi.h"
#include "tests/unit/grain_solids.h"
#include "tests/verification/sieve_oracle.h"

namespace trackbed::dem {
namespace {

using namespace solids;

std::vector<Sphere> at_vertices(const Polyhedron& body, double radius) {
  std::vector<Sphere> spheres;
  for (const Vec3& v : body.vertices) spheres.push_back({v, radius});
  return spheres;
}

TEST(DiscHull, ArcsAreTheFarthestDiscs) {
  Random random(3);
  for (int trial = 0; trial < 300; ++trial) {
    std::vector<Disc> discs;
    for (int k = 0; k < 1 + trial % 12; ++k) {
      const double x = random.uniform(-1, 1), y = random.uniform(-1, 1);
      discs.push_back({x, y, trial % 3 ? random.uniform(0, 0.8) : 0.3});
    }
    const auto arcs = disc_hull(discs);
    for (size_t k = 0; k < arcs.size(); ++k) {
      const double to = k + 1 < arcs.size() ? arcs[k + 1].angle : 2 * M_PI;
      EXPECT_LE(arcs[k].angle, to);
      for (double t : {0.0, 0.3, 0.7, 1.0}) {
        const double a = arcs[k].angle + t * (to - arcs[k].angle);
        const auto reach = [&](const Disc& d) {
          return d.x * std::cos(a) + d.y * std::sin(a) + d.radius;
        };
        double most = -1e300;
        for (const Disc& d : discs) most = std::max(most, reach(d));
        EXPECT_NEAR(reach(discs[arcs[k].disc]), most, 1e-9);
      }
    }
  }
}

TEST(ClumpSieveSize, KnownClumps) {
  const auto size = [](const std::vector<Sphere>& s) { return exact_sieve_size(s).size; };
  EXPECT_NEAR(size({{{1, 2, 3}, 0.5}}), 1, 1e-12);
  EXPECT_NEAR(size({{{0, 0, 0}, 0.5}, {{3, 1, 0}, 0.5}}), 1, 1e-12);  // passes along its axis
  EXPECT_NEAR(size({{{0, 0, 0}, 0.5}, {{3, 1, 0}, 0.2}, {{-1, -1 / 3., 0}, 0.1}}), 1, 1e-9);
  // Three equal spheres in a plane: the triangle's least width, turned by 45 degrees, plus 2 R.
  const double r = 0.1, height = std::sqrt(0.75);
  EXPECT_NEAR(size({{{0, 0, 0}, r}, {{1, 0, 0}, r}, {{0.5, height, 0}, r}}),
              height / std::sqrt(2.0) + 2 * r, 1e-6);
  EXPECT_NEAR(size(at_vertices(tetrahedron(), 0.3)), std::sqrt(0.5) + 0.6, 2e-6);
  EXPECT_NEAR(size(at_vertices(octahedron(), 0.3)), 2 * std::sqrt(2.0) / 3 + 0.6, 2e-6);
  EXPECT_NEAR(size(at_vertices(moved(make_box({64, 30, 100}), any_turn, {1, 2, 3}), 2)), 68, 1e-4);
}

TEST(ClumpSieveSize, EqualSpheresAtVerticesAreTheDilatedGrain) {
  VoronoiParameters v;
  v.count = 20;
  for (const Polyhedron& core : voronoi_grains(v)) {
    const double dilated = sieve_size(DilatedPolyhedron{core, 0.1});
    EXPECT_NEAR(dilated, sieve_size(core) + 0.2, 1e-12);
    const ExactSieveSize s = exact_sieve_size(at_vertices(core, 0.1));
    EXPECT_NEAR(s.size, dilated, 2e-6);
    EXPECT_LE(s.size - s.lower_bound, 1e-6 * s.size);
  }
}

TEST(ClumpSieveSize, AgreesWithBruteForce) {
  Random random(11);
  for (int trial = 0; trial < 40; ++trial) {
    std::vector<Sphere> clump;
    if (trial < 30) {
      for (int k = 0; k < 2 + trial; ++k) {
        const double r = random.uniform(0.05, trial % 2 ? 0.9 : 0.3);
        clump.push_back({random.uniform() * random.direction(), r});
      }
    } else {
      JinParameters j;
      j.length = 1.5, j.width = 1.1, j.height = 0.9;
      FillingParameters f;
      f.least_radius = 0.12;
      clump = fill_with_spheres(jin_stone(j, random), f);
    }
    const ExactSieveSize s = exact_sieve_size(clump);
    EXPECT_NEAR(std::max(width(clump, s.u), width(clump, s.v)), s.size, 1e-12);
    EXPECT_LT(std::abs(s.u.dot(s.v)), 1e-12);
    EXPECT_LE(s.size - s.lower_bound, 1e-6 * s.size);
    const double oracle = brute_force(clump, 5);
    EXPECT_LE(s.size, oracle * (1 + 1e-6)) << trial;
    EXPECT_GE(oracle, s.lower_bound * (1 - 1e-12)) << trial;
    EXPECT_NEAR(s.size / oracle, 1, 1e-5) << trial;
  }
}

TEST(RoundedSieveSize, OtherMethods) {
  const Polyhedron box = moved(make_box({64, 4, 100}), any_turn, {1, 2, 3});
  EXPECT_NEAR(sieve_size(DilatedPolyhedron{box, 3}, SieveMethod::elias2014), 70, 1e-9);
  EXPECT_NEAR(sieve_size(at_vertices(box, 3), SieveMethod::elias2014), 70, 1e-9);
  const double v = dilated_volume({box, 3});
  EXPECT_NEAR(sieve_size(DilatedPolyhedron{box, 3}, SieveMethod::equal_cube), std::cbrt(v), 1e-9);
  const std::vector<Sphere> ball = {{{0, 0, 0}, 2}};
  EXPECT_NEAR(sieve_size(ball, SieveMethod::equal_sphere), 4, 1e-12);
  for (SieveMethod m : {SieveMethod::shao2017, SieveMethod::min_shadow}) {
    EXPECT_THROW(sieve_size(ball, m), InputError);
    EXPECT_THROW(sieve_size(DilatedPolyhedron{box, 3}, m), InputError);
  }
}

}  // namespace
}  // namespace trackbed::dem
