// Dilated polyhedra: Steiner's volume and the exact inertia against Sun 2015 and against each
// other.
#include <gtest/gtest.h>

#include "base/error.h"
#include "dem/grading/rounded_sieve_size.h"
#include "dem/grain/dilated.h"
#include "dem/grain/dilated_shape.h"
#include "dem/grain/random.h"
#include "dem/grain/voronoi.h"
#include "known/dilated_cells.h"

namespace trackbed::dem {
namespace {

using namespace solids;

TEST(Dilated, MeanCurvature) {
  EXPECT_NEAR(mean_curvature(tetrahedron()), 5.731899709, 1e-9);
  EXPECT_NEAR(mean_curvature(make_box({1, 1, 1})), 3 * M_PI, 1e-12);
  EXPECT_NEAR(mean_curvature(make_box({0.4, 1.7, 3})), M_PI * 5.1, 1e-12);
}

// Cube and tetrahedron of edge 1 with r = 1/10 and 1/5 (Sun 2015, Fig 2).
TEST(Dilated, CubeAndTetrahedron) {
  const Polyhedron cube = moved(make_box({1, 1, 1}), any_turn, {3, -2, 5});
  const Polyhedron tetra = moved(tetrahedron(), any_turn, {3, -2, 5});
  const struct {
    Polyhedron core;
    double r, volume, inertia;
  } cases[] = {{cube, 0.1, 1.69843657, 0.39939138},
               {cube, 0.2, 2.61050144, 0.80728541},
               {tetra, 0.1, 0.352563998, 0},
               {tetra, 0.2, 0.727047602, 0}};
  for (const auto& c : cases) {
    const MassProperties p = mass_properties(DilatedPolyhedron{c.core, c.r});
    EXPECT_NEAR(p.volume, c.volume, 6e-9);
    EXPECT_NEAR(dilated_volume({c.core, c.r}), p.volume, 1e-12);
    EXPECT_LT((p.centroid - Vec3(3, -2, 5)).norm(), 1e-12);
    const double one = c.inertia > 0 ? c.inertia : p.inertia(0, 0);
    EXPECT_LT((p.inertia - one * Mat3::Identity()).norm(), 2e-8);  // isotropic
  }
}

// Small cells come to the same with more than first order (mean over a few numbers: counting
// jumps).
TEST(Dilated, CellsConvergeToSteiner) {
  const double volume = 1 + 6 * .2 + 3 * M_PI * .04 + 4 / 3. * M_PI * .008;
  EXPECT_NEAR(dilated_volume({make_box({1, 1, 1}), .2}), volume, 1e-14);
  const double inertia = mass_properties(DilatedPolyhedron{make_box({1, 1, 1}), .2}).inertia(0, 0);
  double coarse = 0, fine = 0;
  for (int n = 0; n < 6; ++n) {
    const known::CellSum a = known::dilated_cube_by_cells(.2, 12 + n),
                         b = known::dilated_cube_by_cells(.2, 8 * (12 + n));
    coarse += std::abs(a.volume / volume - 1) + std::abs(a.inertia / inertia - 1);
    fine += std::abs(b.volume / volume - 1) + std::abs(b.inertia / inertia - 1);
  }
  EXPECT_GT(std::log(coarse / fine) / std::log(8.), 1.2);
  EXPECT_LT(fine / 12, 2e-3);
}

// A box of edge e -> 0 is a ball; a rod is a spherocylinder.
TEST(Dilated, BallAndSpherocylinder) {
  const double r = 0.7, e = 1e-7;
  const MassProperties ball = mass_properties(DilatedPolyhedron{make_box({e, e, e}), r});
  EXPECT_NEAR(ball.volume, 4 / 3. * M_PI * r * r * r, 1e-5);
  EXPECT_NEAR(ball.inertia(2, 2), 8 / 15. * M_PI * std::pow(r, 5), 1e-5);
  const double length = 3, cylinder = M_PI * r * r * length, half = 2 / 3. * M_PI * r * r * r;
  const MassProperties rod = mass_properties(DilatedPolyhedron{make_box({length, e, e}), r});
  EXPECT_NEAR(rod.volume, cylinder + 2 * half, 1e-5);
  EXPECT_NEAR(rod.inertia(0, 0), cylinder * r * r / 2 + 2 * half * 0.4 * r * r, 1e-5);
  const double across = cylinder * (length * length / 12 + r * r / 4) +
                        2 * half * (0.4 * r * r + length * length / 4 + 3 / 8. * length * r);
  EXPECT_NEAR(rod.inertia(1, 1), across, 1e-4);
}

// Grains without symmetry against random points.
TEST(Dilated, GrainsAgainstRandomPoints) {
  VoronoiParameters v;
  v.count = 3;
  for (const Polyhedron& core : voronoi_grains(v)) {
    const double r = 0.25;
    const MassProperties p = mass_properties(DilatedPolyhedron{core, r});
    EXPECT_NEAR(p.volume, dilated_volume({core, r}), 1e-12 * p.volume);
    // Exact distance to the core by faces, edges, vertices would repeat the code; projecting onto
    // the half-spaces alternately (Dykstra) shares nothing with it.
    std::vector<Vec3> normal;
    std::vector<double> offset;
    Vec3 low = core.vertices[0], high = low;
    for (const Vec3& x : core.vertices) low = low.cwiseMin(x), high = high.cwiseMax(x);
    for (const auto& face : core.faces) {
      Vec3 n = Vec3::Zero();
      for (size_t k = 0; k < face.size(); ++k)
        n += core.vertices[face[k]].cross(core.vertices[face[(k + 1) % face.size()]]);
      normal.push_back(n.normalized());
      offset.push_back(normal.back().dot(core.vertices[face[0]]));
    }
    const auto distance = [&](const Vec3& point) {
      Vec3 x = point;
      std::vector<Vec3> correction(normal.size(), Vec3::Zero());
      for (int sweep = 0; sweep < 60; ++sweep)
        for (size_t f = 0; f < normal.size(); ++f) {
          const Vec3 y = x + correction[f];
          const double over = std::max(0.0, normal[f].dot(y) - offset[f]);
          x = y - over * normal[f];
          correction[f] = y - x;
        }
      return (x - point).norm();
    };
    low.array() -= r, high.array() += r;
    Random random(7);
    const int n = 100000;
    double inside = 0;
    Vec3 first = Vec3::Zero();
    Mat3 second = Mat3::Zero();
    for (int k = 0; k < n; ++k) {
      const double a = random.uniform(), b = random.uniform(), c = random.uniform();
      const Vec3 x = low + (high - low).cwiseProduct(Vec3(a, b, c));
      if (distance(x) > r) continue;
      const Vec3 y = x - p.centroid;
      ++inside, first += y, second += y * y.transpose();
    }
    const double share = (high - low).prod() / n;
    EXPECT_NEAR(inside * share, p.volume, 0.02 * p.volume);
    EXPECT_LT(first.norm() * share, 0.02 * p.volume);
    const Mat3 inertia = share * (second.trace() * Mat3::Identity() - second);
    EXPECT_LT((inertia - p.inertia).norm(), 0.02 * p.inertia.norm());
  }
}

// Needles and slivers keep their digits: a box's closed form.
TEST(Dilated, BoxesOfAnyProportion) {
  for (const Vec3& e : {Vec3(1, 1e-3, 1e-3), Vec3(1, 1, 1e-3), Vec3(2, 3, 5)}) {
    const double r = 0.1 * e.minCoeff();
    const MassProperties p =
        mass_properties(DilatedPolyhedron{moved(make_box(e), any_turn, Vec3::Zero()), r});
    const double s = 2 * (e[0] * e[1] + e[1] * e[2] + e[2] * e[0]);
    const double v = e.prod() + s * r + M_PI * e.sum() * r * r + 4 / 3. * M_PI * r * r * r;
    EXPECT_NEAR(p.volume / v, 1, 1e-12);
    EXPECT_GT(p.inertia.determinant(), 0);
  }
}

TEST(DilatedShape, PrincipalFrameAndSieveSize) {
  VoronoiParameters v;
  v.count = 4;
  for (const Polyhedron& core : voronoi_grains(v)) {
    const DilatedPolyhedron given{moved(core, any_turn, {1, 2, 3}), 0.2};
    const DilatedShape shape = make_dilated_shape(given);
    const MassProperties own = mass_properties(shape.body);
    EXPECT_LT(own.centroid.norm(), 1e-14);
    EXPECT_NEAR(shape.volume, dilated_volume(given), 1e-13);
    const Mat3 principal = shape.inertia.asDiagonal();
    EXPECT_LT((own.inertia - principal).norm(), 1e-13);
    EXPECT_LE(shape.inertia[0], shape.inertia[1]);
    EXPECT_LE(shape.inertia[1], shape.inertia[2]);
    for (size_t k = 0; k < core.vertices.size(); ++k)
      EXPECT_LT(
          (shape.turn * shape.body.core.vertices[k] + shape.origin - given.core.vertices[k]).norm(),
          1e-14);
    const DilatedShape twice = scaled(shape, 2);
    EXPECT_NEAR(twice.volume, mass_properties(twice.body).volume, 1e-12);
    EXPECT_NEAR(twice.inertia[2], mass_properties(twice.body).inertia(2, 2), 1e-11);

    GrainShape sized = make_grain_shape(core);
    EXPECT_THROW(dilate_within(sized, 0.1), InputError);
    sized.sieve_size = sieve_size(sized.body);
    EXPECT_NEAR(sieve_size(dilate_within(sized, 0.1).body), sized.sieve_size, 1e-6);
    EXPECT_THROW(dilate_within(sized, 0.5), InputError);
  }
}

TEST(Dilated, RadiusZeroIsTheCore) {
  const Polyhedron t = moved(tetrahedron(), any_turn, {1, 2, 3});
  const MassProperties a = mass_properties(DilatedPolyhedron{t, 0}), b = mass_properties(t);
  EXPECT_NEAR(a.volume, b.volume, 1e-15);
  EXPECT_LT((a.inertia - b.inertia).norm(), 1e-15);
  EXPECT_THROW(mass_properties(DilatedPolyhedron{t, -0.1}), InputError);
  EXPECT_THROW(dilated_volume({t, std::nan("")}), InputError);
}

}  // namespace
}  // namespace trackbed::dem
