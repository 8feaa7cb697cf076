// Thin, tiny and many-faced grains: shapes, sizes, draw and placement.
#include <gtest/gtest.h>

#include <cmath>

#include "dem/contact/overlap.h"
#include "dem/grading/draw.h"
#include "dem/grading/rounded_sieve_size.h"
#include "dem/grain/library.h"
#include "dem/grain/library_report.h"
#include "dem/grain/random.h"
#include "dem/packing/lower.h"
#include "dem/packing/measure.h"
#include "dem/packing/place.h"
#include "dem/surface/rigid.h"
#include "tests/unit/grain_solids.h"

namespace trackbed::dem {
namespace {

using namespace solids;

// Each with its least hole, known by hand or to lie within [low, high].
struct Extreme {
  const char* name;
  Polyhedron body;
  double low, high;
  double certain = 1e-6;  ///< gap between size and certified bound that is allowed
};

Polyhedron ball(int points) {
  Random random(4);
  std::vector<Vec3> p;
  for (int k = 0; k < points; ++k) p.push_back(random.direction());
  return convex_hull(p);
}

// A unit cube with a corner cut off so shallowly that the new face is `share` of a side's.
Polyhedron with_tiny_face(double share) {
  const double cut = std::sqrt(2 * share / std::sqrt(3.0) * 2);
  std::vector<Vec3> p;
  for (int k = 0; k < 8; ++k) {
    const Vec3 corner(k & 1, k >> 1 & 1, k >> 2);
    if (k < 7)
      p.push_back(corner);
    else
      for (int a = 0; a < 3; ++a) p.push_back(corner - cut * Vec3::Unit(a));
  }
  return convex_hull(p);
}

std::vector<Extreme> extremes() {
  return {
      {"needle 1:1000", make_box({1, 1e-3, 1e-3}), 1e-3, 1e-3},
      {"needle 1:1000, pointed",
       convex_hull({{0, 0, 0}, {1, 5e-4, 0}, {1, -3e-4, 4e-4}, {1, -3e-4, -4e-4}, {2, 0, 0}}), 8e-4,
       8e-4, 0.03},  // its tips tie in a whole valley of directions: bounds close in slowly
      {"plate 1:1000", make_box({1, 1, 1e-3}), 1.001 / std::sqrt(2.), 1.001 / std::sqrt(2.)},
      {"face of 1e-6", with_tiny_face(1e-6), 0.999, 1},
      {"face of 1e-10", with_tiny_face(1e-10), 0.99999, 1},
      {"some 200 faces", ball(102), 1.8, 2},
      {"some 600 faces", ball(302), 1.9, 2},
  };
}

TEST(ExtremeGrains, AreSizedCertainlyInAnyPose) {
  for (const Extreme& e : extremes())
    for (const Quat& turn : {Quat::Identity(), any_turn}) {
      const Polyhedron body = moved(e.body, turn, {3, 2, 1}, 0.04);
      const ExactSieveSize s = exact_sieve_size(body);
      EXPECT_GE(s.size, 0.04 * e.low * (1 - 1e-6)) << e.name;
      EXPECT_LE(s.size, 0.04 * e.high * (1 + 1e-6)) << e.name;
      EXPECT_GE(s.lower_bound, s.size * (1 - e.certain)) << e.name;
      if (turn.w() != 1 || body.faces.size() > 300) continue;  // min_shadow tries all face pairs
      for (const std::string& method : sieve_method_names())
        EXPECT_GT(sieve_size(body, parse_sieve_method(method)), 0) << e.name << " " << method;
      EXPECT_NEAR(sieve_size(DilatedPolyhedron{body, 0.002}), s.size + 0.004, 1e-9) << e.name;
    }
  EXPECT_GE(ball(102).faces.size(), 190u);
}

TEST(ExtremeGrains, AreDrawnReportedPlacedAndMeasured) {
  std::vector<GrainShape> library;
  for (const Extreme& e : extremes()) {
    if (e.body.faces.size() > 300) continue;
    const GrainShape s = make_grain_shape(e.body);
    library.push_back(scaled(s, 1 / sieve_size(s.body)));
    library.back().sieve_size = 1;
  }
  const LibraryReport report = library_report(library);
  for (const Spread& s : {report.elongation, report.flatness, report.sphericity})
    EXPECT_TRUE(s.least > 0 && s.largest <= 1 + 1e-9);

  // A needle of a 3 mm hole is 3 m long: placement keeps even such grains apart.
  std::vector<double> radii;
  for (GrainShape& s : library) {
    s = scaled(s, 0.05 / s.radius);
    radii.push_back(s.radius);
  }
  PlacementSpace space;
  space.low = Vec3(0, 0, 0), space.high = Vec3(0.3, 0.3, 1);
  space.period = Vec3(0, 0.3, 0);
  const Placement p = place_loose(radii, space, {}, 20, 3);
  ShapeTable shapes;
  Bodies bodies;
  for (size_t i = 0; i < library.size(); ++i)
    add_grain(bodies, shapes, shapes.add(library[i]), 0, 2600, p.centre[i], p.turn[i]);
  lower_grains(bodies, shapes, 0, 0, space.period, 1e-5);
  double volume = 0;
  for (int i = 0; i < bodies.size(); ++i) {
    volume += library[i].volume;
    EXPECT_TRUE(bodies.x[i].allFinite());
    for (int j = 0; j < i; ++j) {
      const Vec3 image = bodies.x[j] + nearest_image(bodies.x[i], bodies.x[j], space.period);
      Vec3 axis = image - bodies.x[i];
      EXPECT_GT(separating_axis(shapes.view(bodies.shape[i]), {bodies.R[i], bodies.x[i]},
                                shapes.view(bodies.shape[j]), {bodies.R[j], image}, axis),
                0)
          << i << " " << j;
    }
  }
  const RegionMeasure m = measure(placed_grains(bodies, shapes), {}, space.period,
                                  box_region({0, 0.1, -0.01}, {0.3, 0.4, 1}));
  EXPECT_NEAR(m.solid_volume, volume, 1e-10 * volume);
}

TEST(ExtremeGrains, ComeOutOfTheGeneratorsWhole) {
  for (const char* generator : {"voronoi", "ellipsoid", "jin_hull"}) {
    LibraryParameters p;
    p.generator = generator, p.count = 8, p.method = SieveMethod::equal_cube;
    p.spacing = 0, p.least_face = 0;  // a Poisson process: slivers and specks of faces
    p.axes = Vec3(1, 0.05, 0.002);
    p.points_least = 100, p.points_most = 110;
    p.length_over_height = 15, p.length_over_height_deviation = 0.5;
    p.divisions = 6, p.least_scale = 0.6, p.largest_scale = 1.4;
    for (const GrainShape& s : make_library(p)) {
      const ExactSieveSize size = exact_sieve_size(s.body);
      EXPECT_GE(size.lower_bound, size.size * (1 - 1e-6)) << generator;
      EXPECT_TRUE(s.inertia.allFinite() && s.inertia.minCoeff() > 0) << generator;
    }
  }
}

}  // namespace
}  // namespace trackbed::dem
