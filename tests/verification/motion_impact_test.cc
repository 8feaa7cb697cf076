// A cube falls on a plane without friction, e = 1: the impulse of rigid-body theory,
// J = 2 m v/(1 + m (r x n).I^-1 (r x n)), is the stiff limit of the contact law. Tolerance 1 %
// with an overlap below 1e-3 of the edge.
#include <gtest/gtest.h>

#include <array>

#include "motion_scene.h"

namespace trackbed::dem {
namespace {

struct Rebound {
  double v, omega, depth, closure;
};

Rebound cube_drop(double tilt, double share_of_limit = .02) {
  const double a = 1, v = 1, rho = 1, E = 1e8;
  Scene s(E, 0);
  s.context.gravity.setZero();
  const Quat q = turn_about({0, 1, 0}, tilt);
  const double low = a / 2 * (std::cos(tilt) + std::sin(tilt));
  s.add_block({a, a, a}, rho, {0, 0, low + 1e-4}, q);
  s.add_floor(5, 1);
  s.bodies.v[0] = {0, 0, -v};
  const double omega = std::sqrt(.7522527780636751 * E * a / (rho * a * a * a));
  s.context.dt = share_of_limit * 2 / omega;
  s.prepare();
  Rebound r{0, 0, 0, 0};
  bool touched = false;
  for (int k = 0; k < 200000; ++k) {
    s.step();
    const bool touching = count_contacts(s.pairs) > 0;
    touched |= touching;
    if (touching) r.depth = std::max(r.depth, s.pairs.depth[0]);
    if (touched && !touching) break;
  }
  r.v = s.bodies.v[0].z() / v;
  r.omega = std::abs(s.bodies.omega[0].y()) * a / v;
  r.closure = s.closure();
  return r;
}

class CubeImpact : public ::testing::TestWithParam<std::array<double, 3>> {};

TEST_P(CubeImpact, rebounds_as_theory_says) {
  const auto [degrees, v, omega] = GetParam();
  const Rebound r = cube_drop(degrees * M_PI / 180);
  EXPECT_NEAR(r.v, v, .01);
  EXPECT_NEAR(r.omega, omega, .01 * std::max(1., omega));
  EXPECT_LT(r.depth, 1e-3);
  EXPECT_GT(r.depth, 1e-6);
  EXPECT_LT(std::abs(r.closure), 1e-3 * .5);
}

INSTANTIATE_TEST_SUITE_P(tilt, CubeImpact,
                         ::testing::Values(std::array{15., .142857, 2.424366},
                                           std::array{45., 1., 0.}, std::array{0., 1., 0.}));

TEST(CubeImpact, energy_closes_with_second_order) {
  const double e1 = std::abs(cube_drop(15 * M_PI / 180, .02).closure);
  const double e2 = std::abs(cube_drop(15 * M_PI / 180, .005).closure);
  RecordProperty("closure_J_at_0.02", std::to_string(e1));
  EXPECT_LT(e2, 1e-5);
  EXPECT_GT(std::log(e1 / e2) / std::log(4.), 1.5);
}

}  // namespace
}  // namespace trackbed::dem
