// From curves and profiles to friction angles, against published and exact values.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "apps/trackbed/grain_tests/profile.h"
#include "apps/trackbed/grain_tests/strength.h"
#include "base/error.h"

namespace trackbed::apps {
namespace {

constexpr double kDegree = M_PI / 180;

TEST(FitLine, AnscombesFirstSet) {
  // Anscombe, The American Statistician 27 (1973) 17: y = 3.00 + 0.500 x, standard error of the
  // slope 0.118; of the intercept 1.125 by the same regression.
  const std::vector<double> x{10, 8, 13, 9, 11, 14, 6, 4, 12, 7, 5};
  const std::vector<double> y{8.04, 6.95, 7.58, 8.81, 8.33, 9.96, 7.24, 4.26, 10.84, 4.82, 5.68};
  const Line line = fit_line(x, y);
  EXPECT_NEAR(line.slope, 0.500, 5e-4);
  EXPECT_NEAR(line.intercept, 3.00, 5e-3);
  EXPECT_NEAR(line.slope_error, 0.118, 5e-4);
  EXPECT_NEAR(line.intercept_error, 1.125, 5e-4);
}

TEST(FitLine, NeedsTwoPointsApart) {
  EXPECT_THROW(fit_line({1, 1}, {2, 3}), InputError);
  const Line two = fit_line({0, 2}, {1, 5});
  EXPECT_DOUBLE_EQ(two.slope, 2);
  EXPECT_TRUE(std::isnan(two.slope_error));  // no degree of freedom is left
}

TEST(FitLine, StudentsTable) {
  EXPECT_NEAR(confidence_factor(1), 12.706, 1e-3);
  EXPECT_NEAR(confidence_factor(10), 2.228, 1e-3);
  EXPECT_TRUE(std::isnan(confidence_factor(0)));
}

TEST(MohrCoulombFit, IsExactOnExactPoints) {
  const double angle = 41 * kDegree, cohesion = 7e3;
  std::vector<double> normal, shear, major, minor;
  for (const double s : {20e3, 60e3, 150e3, 200e3}) {
    normal.push_back(s), shear.push_back(cohesion + s * std::tan(angle));
    // Failure of a specimen confined by s: s1 = s N + 2 c sqrt(N), N = (1 + sin)/(1 - sin).
    const double n = (1 + std::sin(angle)) / (1 - std::sin(angle));
    minor.push_back(s), major.push_back(s * n + 2 * cohesion * std::sqrt(n));
  }
  for (const MohrCoulomb& m : {fit_shear(normal, shear), fit_triaxial(major, minor)}) {
    EXPECT_NEAR(m.angle.value, angle, 1e-12);
    EXPECT_NEAR(m.cohesion.value, cohesion, 1e-7);
    EXPECT_LT(m.angle.error, 1e-8);
    EXPECT_EQ(m.points, 4);
  }
  EXPECT_NEAR(principal_angle(3, 1), 30 * kDegree, 1e-15);
}

TEST(MohrCoulombFit, ErrorOfTheAngleIsThatOfTheSlope) {
  // A slope moved by its error moves the angle by the angle's.
  const std::vector<double> normal{1, 2, 3}, shear{0.9, 1.72, 2.7};
  const Line line = fit_line(normal, shear);
  const double moved = std::atan(line.slope + 1e-4 * line.slope_error) - std::atan(line.slope);
  EXPECT_NEAR(fit_shear(normal, shear).angle.error, 1e4 * moved, 1e-4 * moved * 1e4);
}

TEST(Peak, IsTheHighestMean) {
  // One outlier of 9 is not a peak of three rows: 4, 5, 6 are.
  EXPECT_EQ(peak_rows({0, 1, 9, 1, 4, 5, 6, 2, 0}, 3), 4);
  EXPECT_EQ(peak_rows({1, 2}, 5), 0);
  const Estimate mean = mean_of({1, 2, 3, 6}, 1, 2);
  EXPECT_DOUBLE_EQ(mean.value, 2.5);
  EXPECT_DOUBLE_EQ(mean.error, 0.5);
}

// Of the grain with these corners.
dem::PlacedGrain grain(const std::vector<dem::Vec3>& corners) {
  auto outline = std::make_shared<dem::GrainOutline>();
  outline->bodies.push_back(dem::convex_hull(corners));
  dem::PlacedGrain g;
  g.outline = outline;
  g.radius = 10;
  return g;
}

// A block of height 1 from x = 0 to 1, then two wedges beside each other, of these angles.
std::vector<dem::PlacedGrain> heap(double front, double back) {
  std::vector<dem::Vec3> block, wedges[2];
  for (const double y : {-1., 1.})
    for (const double x : {0., 1.})
      for (const double z : {0., 1.}) block.emplace_back(x, y, z);
  for (const int k : {0, 1})
    for (const double y : {k - 1., k + 0.}) {
      const double end = 1 + 1 / std::tan(k == 0 ? front : back);
      wedges[k].emplace_back(1, y, 0), wedges[k].emplace_back(1, y, 1);
      wedges[k].emplace_back(end, y, 0);
    }
  return {grain(block), grain(wedges[0]), grain(wedges[1])};
}

TEST(HeapProfile, OfAWedgeHasItsAngle) {
  for (const double degrees : {15., 30., 45.}) {
    auto profile = heap_profile(heap(degrees * kDegree, degrees * kDegree), dem::Vec3::Zero(),
                                {{1, -0.3}, {1, 0.2}}, 0, 6, 0, 48);
    const Estimate angle = slope_angle(profile);
    EXPECT_NEAR(angle.value, degrees * kDegree, 1e-12);
    EXPECT_LT(angle.error, 1e-8);
    EXPECT_FALSE(profile.front().fitted);
    EXPECT_DOUBLE_EQ(profile.front().height, 1);
    EXPECT_EQ(profile.back().height, 0);
    EXPECT_NEAR(profile[20].cuts[0], profile[20].cuts[1], 1e-12);
  }
}

TEST(HeapProfile, ErrorIsThatOfTheMeanOfTheCuts) {
  // Cuts of 30 and 38 degrees: deviation 8/sqrt(2), of their mean 8/2.
  auto profile = heap_profile(heap(30 * kDegree, 38 * kDegree), dem::Vec3::Zero(),
                              {{1, -0.5}, {1, 0.5}}, 0, 6, 0, 48);
  const Estimate angle = slope_angle(profile);
  EXPECT_NEAR(angle.error, 4 * kDegree, 1e-12);
  // The mean height falls with the mean of both slopes.
  const double mean = (std::tan(30 * kDegree) + std::tan(38 * kDegree)) / 2;
  EXPECT_NEAR(angle.value, std::atan(mean), 1e-12);
}

TEST(HeapProfile, WithoutASlopeHasNoAngle) {
  auto flat =
      heap_profile(heap(80 * kDegree, 80 * kDegree), dem::Vec3::Zero(), {{1, 0.1}}, 0, 1.1, 0, 4);
  EXPECT_TRUE(std::isnan(slope_angle(flat).value));
}

}  // namespace
}  // namespace trackbed::apps
