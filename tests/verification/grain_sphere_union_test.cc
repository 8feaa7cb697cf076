// Volume, centroid and inertia of sphere unions: closed forms, slices, hard configurations.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "dem/grain/random.h"
#include "dem/grain/sphere_union.h"
#include "known/filled_stones.h"

namespace trackbed::dem {
namespace {

double ball(double r) { return 4 / 3. * M_PI * r * r * r; }
double lens(double r, double s, double d) {
  return M_PI * std::pow(r + s - d, 2) * (d * d + 2 * d * (r + s) - 3 * (r - s) * (r - s)) /
         (12 * d);
}
double distance_for_lens(double r, double s, double volume) {
  double near = std::abs(r - s), far = r + s;
  for (int k = 0; k < 200; ++k)
    (lens(r, s, 0.5 * (near + far)) > volume ? near : far) = 0.5 * (near + far);
  return near;
}
std::vector<Sphere> random_clump(int n, std::uint64_t seed) {
  Random random(seed);
  std::vector<Sphere> spheres;
  for (int k = 0; k < n; ++k)
    spheres.push_back({random.uniform() * random.direction(), random.uniform(0.2, 0.6)});
  return spheres;
}

TEST(SphereUnion, OneSphere) {
  const MassProperties p = mass_properties(std::vector<Sphere>{{{1, 2, 3}, 0.7}});
  EXPECT_NEAR(p.volume, ball(0.7), 1e-14);
  EXPECT_LT((p.centroid - Vec3(1, 2, 3)).norm(), 1e-14);
  EXPECT_LT((p.inertia - 0.4 * 0.49 * ball(0.7) * Mat3::Identity()).norm(), 1e-14);
}

// Axisymmetric: discs of radius rho(z), integrated piece by piece (polynomials: Simpson is exact).
TEST(SphereUnion, TwoSpheresOfAnyDistance) {
  for (double r : {1.0, 0.5, 0.99})
    for (double d : {0.0, 0.001, 0.3, 0.499, 0.5, 0.51, 0.87, 0.999, 1.2, 1.4, 1.499, 1.5, 2.5}) {
      const Vec3 axis = Vec3(1, -2, 0.5).normalized(), at(3, 1, -2);
      const MassProperties p = mass_properties(std::vector<Sphere>{{at, 1}, {at + d * axis, r}});
      const bool inside = d + r <= 1, apart = d >= 1 + r;
      const double v = inside ? ball(1) : ball(1) + ball(r) - (apart ? 0 : lens(1, r, d));
      EXPECT_NEAR(p.volume, v, 1e-12) << r << ' ' << d;
      double first = 0, polar = 0, along = 0;
      const auto piece = [&](double from, double to, double centre, double radius) {
        for (int k = 0; k < 64; ++k) {  // 5th-order polynomials: Simpson on 64 panels
          const double h = (to - from) / 64, z0 = from + k * h;
          for (int m = 0; m < 3; ++m) {
            const double z = z0 + m * h / 2, w = (m == 1 ? 4 : 1) * h / 6;
            const double a = M_PI * (radius * radius - (z - centre) * (z - centre));
            first += w * a * z, polar += w * a * a / (2 * M_PI);
            along += w * (a * z * z + a * a / (4 * M_PI));
          }
        }
      };
      const double cut = d > 0 ? 0.5 * (d + (1 - r * r) / d) : 1;
      piece(-1, inside || apart ? 1 : cut, 0, 1);
      if (!inside) piece(apart ? d - r : cut, d + r, d, r);
      EXPECT_LT((p.centroid - at - first / v * axis).norm(), 1e-12);
      EXPECT_NEAR(axis.dot(p.inertia * axis), polar, 1e-6);
      const Vec3 across = axis.unitOrthogonal();
      EXPECT_NEAR(across.dot(p.inertia * across), along - first * first / v, 1e-6);
    }
}

// Jin 2017, Table 1: one sphere of 7 mm, two and three overlapping ones whose least is 7 mm, with
// the volumes of the paper (it gives no coordinates): to less than 0.1 % by slices, where its own
// pixels err by 2.7, 1.8 and 1.6 %.
TEST(SphereUnion, JinTable1) {
  std::vector<Sphere> spheres = {{{0, 0, 0}, 0.7}};
  const double exact[] = {1.4367, 5.0961, 9.2326};
  EXPECT_NEAR(mass_properties(spheres).volume, exact[0], 1e-4);
  EXPECT_NEAR(sliced_volume(spheres) / exact[0], 1, 1e-3);
  const Vec3 side = Vec3(1, 2, -0.7).normalized();
  const double d = distance_for_lens(0.7, 1, ball(0.7) + ball(1) - exact[1]);
  spheres.push_back({d * side, 1});
  EXPECT_NEAR(mass_properties(spheres).volume, exact[1], 1e-12);
  EXPECT_NEAR(sliced_volume(spheres) / exact[1], 1, 1e-3);
  const double e = distance_for_lens(1, 1.05, exact[1] + ball(1.05) - exact[2]);
  spheres.push_back({(d + e) * side, 1.05});
  EXPECT_NEAR(mass_properties(spheres).volume, exact[2], 1e-12);
  EXPECT_NEAR(sliced_volume(spheres) / exact[2], 1, 1e-3);
  for (const Sphere& s : spheres)  // the rule itself errs by 0.005 % with 100 slices a sphere
    EXPECT_NEAR(sliced_volume({s}, 100) / ball(s.radius), 1 + 0.5e-4, 1e-6);
}

TEST(SphereUnion, SlicesOfRandomClumpsConverge) {
  for (int n : {3, 10, 60})
    for (int seed = 1; seed <= 5; ++seed) {
      const auto clump = random_clump(n, seed);
      const double v = mass_properties(clump).volume;
      EXPECT_NEAR(sliced_volume(clump, 100) / v, 1, 2e-4) << n;
      EXPECT_NEAR(sliced_volume(clump, 3000) / v, 1, 2e-7) << n;
    }
}

// The mid-slice rule: one sphere's error is 1/(2 n^2) of its volume, n slices over its height.
TEST(SphereUnion, SlicesAreOfSecondOrder) {
  const Sphere ball{Vec3(0.1, -0.2, 0.3), 0.7};
  const double exact = 4 / 3. * M_PI * std::pow(ball.radius, 3);
  for (int n = 10; n <= 640; n *= 2)
    EXPECT_NEAR((sliced_volume({ball}, n) / exact - 1) * n * n, 0.5, 1e-6) << n;
}

TEST(SphereUnion, InertiaOfRandomClumps) {
  const auto clump = random_clump(20, 3);
  const MassProperties p = mass_properties(clump);
  Random random(5);
  const int n = 2000000;
  double count = 0;
  Vec3 first = Vec3::Zero();
  Mat3 second = Mat3::Zero();
  for (int k = 0; k < n; ++k) {
    const double a = random.uniform(-1.6, 1.6), b = random.uniform(-1.6, 1.6);
    const Vec3 x(a, b, random.uniform(-1.6, 1.6));
    if (std::none_of(clump.begin(), clump.end(), [&](const Sphere& s) {
          return (x - s.centre).squaredNorm() < s.radius * s.radius;
        }))
      continue;
    const Vec3 y = x - p.centroid;
    ++count, first += y, second += y * y.transpose();
  }
  const double share = std::pow(3.2, 3) / n;
  EXPECT_NEAR(count * share / p.volume, 1, 0.005);
  EXPECT_LT(first.norm() * share, 0.005 * p.volume);
  const Mat3 inertia = share * (second.trace() * Mat3::Identity() - second);
  EXPECT_LT((inertia - p.inertia).norm(), 0.005 * p.inertia.norm());
}

// Planes that coincide, meet in one line or point, spheres counted twice, hidden spheres.
TEST(SphereUnion, SymmetricAndRepeatedSpheres) {
  std::vector<Sphere> grid;
  for (int k = 0; k < 27; ++k) grid.push_back({Vec3(k % 3, k / 3 % 3, k / 9), 0.8});
  const double v = mass_properties(grid).volume;
  EXPECT_NEAR(sliced_volume(grid, 2000) / v, 1, 1e-6);
  const MassProperties p = mass_properties(grid);
  EXPECT_LT((p.centroid - Vec3(1, 1, 1)).norm(), 1e-12);
  EXPECT_LT((p.inertia - p.inertia(0, 0) * Mat3::Identity()).norm(), 1e-10);
  std::vector<Sphere> twice = grid;
  twice.insert(twice.end(), grid.begin(), grid.end());
  twice.push_back({Vec3(1, 1, 1), 0.1});
  EXPECT_NEAR(mass_properties(twice).volume, v, 1e-11);
  // All covered, though no single sphere holds it: the middle of a tight ring.
  std::vector<Sphere> ring;
  for (int k = 0; k < 6; ++k)
    ring.push_back({0.5 * Vec3(k % 3 == 0, k % 3 == 1, k % 3 == 2) * (k < 3 ? 1 : -1), 1});
  const double outer = mass_properties(ring).volume;
  ring.push_back({Vec3::Zero(), 0.6});
  EXPECT_NEAR(mass_properties(ring).volume, outer, 1e-12);
  // On a line, same plane twice: two equal spheres at one place cut a third.
  EXPECT_NEAR(
      mass_properties(std::vector<Sphere>{{{0, 0, 0}, 1}, {{1, 0, 0}, 1}, {{1, 0, 0}, 1}}).volume,
      2 * ball(1) - lens(1, 1, 1), 1e-12);
}

TEST(SphereUnion, AnyPlaceTurnAndScale) {
  const auto clump = random_clump(30, 9);
  const MassProperties p = mass_properties(clump);
  const Quat turn = Quat(0.3, -0.5, 0.7, 0.2).normalized();
  for (double scale : {1e-9, 1e-3, 1e6}) {
    std::vector<Sphere> moved;
    for (const Sphere& s : clump)
      moved.push_back({scale * (turn * s.centre + Vec3(5, -3, 2)), scale * s.radius});
    const MassProperties q = mass_properties(moved);
    EXPECT_NEAR(q.volume / std::pow(scale, 3) / p.volume, 1, 1e-12);
    const Mat3 r = turn.toRotationMatrix();
    EXPECT_LT((q.inertia / std::pow(scale, 5) - r * p.inertia * r.transpose()).norm(), 1e-11);
  }
}

TEST(SphereUnion, RefusesWrongSpheres) {
  EXPECT_THROW(mass_properties(std::vector<Sphere>{}), InputError);
  EXPECT_THROW(mass_properties(std::vector<Sphere>{{{0, 0, 0}, 0}}), InputError);
  EXPECT_THROW(mass_properties(std::vector<Sphere>{{{0, std::nan(""), 0}, 1}}), InputError);
  EXPECT_THROW(sliced_volume({}), InputError);
  EXPECT_THROW(sliced_volume({{{0, 0, 0}, 1}}, 0), InputError);
}

// Smaller spheres leave out less of a stone, never nothing, and never stand for more than it: the
// ladder of spheres a clump.
TEST(Filling, ErrorFallsWithTheLeastSphereAndStaysAboveZero) {
  double before = 1, spheres = 0;
  std::vector<double> error;
  for (const double least : {.014, .010, .007, .005, .0035}) {
    const known::Filling f = known::missing_inertia(known::fillings(least, 4));
    EXPECT_LT(f.error, before) << least;
    EXPECT_GT(f.error, 0) << least;
    EXPECT_GT(f.spheres, spheres) << least;
    before = f.error, spheres = f.spheres;
    error.push_back(f.error);
  }
  // Spheres fill what is left more and more slowly: by an order below one.
  const double order = std::log(error.front() / error.back()) / std::log(.014 / .0035);
  EXPECT_GT(order, .4);
  EXPECT_LT(order, 1);
}

}  // namespace
}  // namespace trackbed::dem
