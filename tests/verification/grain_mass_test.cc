// Volume and inertia of solids with known values, in any pose, of any size, and of slivers.
#include <gtest/gtest.h>

#include "tests/unit/grain_solids.h"

namespace trackbed::dem {
namespace {

using namespace solids;

struct Case {
  const char* name;
  Polyhedron body;
  double volume, gyration2;  // edge 1: V, I/m about any axis
};

std::vector<Case> regular_solids() {
  return {{"tetrahedron", tetrahedron(), 1 / (6 * std::sqrt(2.)), 0.05},
          {"cube", make_box({1, 1, 1}), 1, 1. / 6},
          {"octahedron", octahedron(), std::sqrt(2.) / 3, 0.1}};
}

TEST(MassProperties, RegularSolidsInAnyPose) {
  for (const Case& c : regular_solids())
    for (double scale : {1e-9, 1., 1e6}) {
      const Vec3 shift = scale * Vec3(3, -5, 7);
      const MassProperties m = mass_properties(moved(c.body, any_turn, shift, scale));
      EXPECT_NEAR(m.volume / std::pow(scale, 3), c.volume, 1e-12 * c.volume) << c.name;
      EXPECT_LT((m.centroid - shift).norm(), 1e-12 * scale * 10) << c.name;
      const Mat3 expected = c.volume * c.gyration2 * Mat3::Identity();
      EXPECT_LT((m.inertia / std::pow(scale, 5) - expected).norm(), 1e-12) << c.name;
    }
}

TEST(MassProperties, SliversKeepTheirDigits) {
  for (const Vec3& e : {Vec3(1, 1e-3, 1e-3), Vec3(1, 1, 1e-3), Vec3(1e-3, 1, 2e-3)}) {
    const Polyhedron turned = moved(make_box(e), any_turn, {1, 2, 3});
    for (const Polyhedron& body : {turned, convex_hull(turned.vertices)}) {
      const GrainShape s = make_grain_shape(body);
      EXPECT_NEAR(s.volume / e.prod(), 1, 1e-9);
      Vec3 sorted = e;
      std::sort(sorted.data(), sorted.data() + 3);
      const double x = sorted[2], y = sorted[1], z = sorted[0];
      const Vec3 expected = s.volume / 12 * Vec3(y * y + z * z, x * x + z * z, x * x + y * y);
      EXPECT_GT(s.inertia.minCoeff(), 0);
      for (int i = 0; i < 3; ++i) EXPECT_NEAR(s.inertia[i] / expected[i], 1, 1e-9);
    }
  }
}

// A corner of edge 1e-6 cut off a cube: a face of area 1e-12 that is neither lost nor harmful.
TEST(MassProperties, TinyFaceIsKept) {
  const double h = 1e-6;
  std::vector<Vec3> p = make_box({1, 1, 1}).vertices;
  p.pop_back();
  p.insert(p.end(), {{.5 - h, .5, .5}, {.5, .5 - h, .5}, {.5, .5, .5 - h}});
  const Polyhedron body = convex_hull(p);
  EXPECT_EQ(body.faces.size(), 7u);
  EXPECT_NEAR(mass_properties(body).volume, 1 - h * h * h / 6, 1e-12);
}

}  // namespace
}  // namespace trackbed::dem
