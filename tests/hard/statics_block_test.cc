// Blocks at rest, sliding and toppling, against theory. No damping unless a test says so.
#include <gtest/gtest.h>

#include "motion_scene.h"

namespace trackbed::dem {
namespace {

constexpr double kShaoStiffness = .7522527780636751;

// A block resting on a plane tilted by `angle` about y (gravity turned instead of the plane),
// sunk in by its weight so that it starts in balance.
Scene block_on_plane(double angle, double mu, const Vec3& edges, double share = .05,
                     double E = 1e8) {
  const double rho = 1000, g = 9.81, area = edges.x() * edges.y();
  const double m = rho * area * edges.z(), k = kShaoStiffness * E * std::sqrt(area);
  Scene s(E, mu);
  s.context.gravity = g * Vec3(std::sin(angle), 0, -std::cos(angle));
  const double sink = m * g * std::cos(angle) / k;
  s.add_block(edges, rho, {0, 0, edges.z() / 2 - sink});
  s.add_floor(20, 1);
  s.prepare();
  s.context.dt = share * measured_limit(s.bodies, s.pairs, 1).dt;
  return s;
}

// Slope raised slowly to the angle, the last vibrations damped away: way slid after that.
double slid_after_ramp(double tan_angle, double mu) {
  Scene s = block_on_plane(0, mu, {.2, .2, .05}, .2);
  const double angle = std::atan(tan_angle), ramp = .2;
  s.context.local_damping = .4;
  s.drive = [=](Scene& w) {
    const double now = angle * std::min(1., w.time / ramp);
    w.context.gravity = 9.81 * Vec3(std::sin(now), 0, -std::cos(now));
  };
  s.run(.3);
  const double before = s.bodies.x[0].x();
  s.run(.6);
  return s.bodies.x[0].x() - before;
}

TEST(Incline, slips_only_above_the_friction_angle) {
  const double mu = .5;
  EXPECT_LT(slid_after_ramp(mu - 1e-3, mu), 1e-9);
  EXPECT_GT(slid_after_ramp(mu + 1e-3, mu), 1e-4);
}

// The tangential spring takes its first millisecond to load, so way is counted after that.
TEST(Incline, slides_as_far_as_theory_says) {
  const double mu = .3, angle = std::atan(.5), t = .3;
  Scene s = block_on_plane(angle, mu, {.2, .2, .05});
  s.run(.05);
  const double x = s.bodies.x[0].x(), v = s.bodies.v[0].x(), t0 = s.time;
  s.run(t0 + t);
  const double way = s.bodies.x[0].x() - x - v * (s.time - t0);
  const double expected = .5 * 9.81 * (std::sin(angle) - mu * std::cos(angle)) * t * t;
  EXPECT_NEAR(way, expected, 1e-3 * expected);
}

TEST(Incline, topples_only_beyond_its_base) {
  for (const double share : {.98, 1.02}) {
    const double b = .1, h = .2;  // topples iff tan > b/h = .5
    Scene s = block_on_plane(0, 2, {b, b, h});
    s.context.local_damping = .3;
    // Tilt slowly, so that the start is no jolt.
    const double angle = std::atan(share * b / h), ramp = .3;
    s.drive = [=](Scene& w) {
      const double now = angle * std::min(1., w.time / ramp);
      w.context.gravity = 9.81 * Vec3(std::sin(now), 0, -std::cos(now));
    };
    s.context.dt *= 4;
    s.run(1.5);
    const double tilt = std::acos(std::min(1., s.bodies.R[0].col(2).cwiseAbs().maxCoeff()));
    if (share < 1)
      EXPECT_LT(tilt, 1e-3);
    else
      EXPECT_GT(s.bodies.x[0].x() - 0, .02) << "tilt " << tilt;
  }
}

TEST(Incline, a_sticking_block_does_not_creep) {
  Scene s = block_on_plane(std::atan(.3), .5, {.2, .2, .1});
  s.context.local_damping = .4;
  s.context.dt *= 4;
  s.run(.5);
  const double before = s.bodies.x[0].x();
  const double t = s.time;
  s.context.local_damping = 0;
  s.run(1.);
  EXPECT_LT(std::abs(s.bodies.x[0].x() - before) / (s.time - t), 1e-10);
}

TEST(Block, placed_in_balance_stays) {
  Scene s = block_on_plane(0, .5, {.2, .2, .1});
  const double z = s.bodies.x[0].z();
  s.run(.2);
  EXPECT_NEAR(s.bodies.x[0].z(), z, 1e-12);
  EXPECT_LT(s.bodies.v[0].norm(), 1e-10);
  EXPECT_LT(s.bodies.omega[0].norm(), 1e-9);
}

// A cube pressed on a plane: omega^2 = k/m up and down, 9/4 k a^2/12 / (m a^2/6) = 1.125 k/m
// rocking. The measured limit may be up to 12 % below the true one, never above.
TEST(TimeStep, limit_of_a_rocking_cube) {
  Scene s = block_on_plane(0, 0, {.2, .2, .2});
  const TimeStepLimit limit = measured_limit(s.bodies, s.pairs, 1);
  const double k = kShaoStiffness * 1e8 * .2, exact = 2 / std::sqrt(1.125 * k / 8);
  EXPECT_LE(limit.dt, exact);
  EXPECT_GT(limit.dt, .88 * exact);
  for (const double share : {.95, 1.05}) {
    Scene t = s;
    set_spin(t.bodies, 0, {0, 1e-9, 0});
    t.context.dt = share * exact;
    for (int i = 0; i < 200; ++i) t.step();
    if (share < 1)
      EXPECT_LT(t.bodies.omega[0].norm(), 1e-7);
    else
      EXPECT_GT(t.bodies.omega[0].norm(), 1e-3);
  }
}

// Penetration does not depend on the size of the base.
TEST(Block, on_a_large_base) {
  double depth[2];
  for (int k = 0; k < 2; ++k) {
    Scene s(1e8, 0);
    s.context.gravity = {0, 0, -9.81};
    s.add_block({.01, .01, .01}, 1000, {0, 0, .005 - 1e-6});
    s.add_floor(k == 0 ? 1 : 100, 1);
    s.prepare();
    depth[k] = s.bodies.force[0].z();
  }
  EXPECT_NEAR(depth[1], depth[0], 1e-8 * depth[0]);
}

Scene stack(int blocks, double E = 1e9) {
  Scene s(E, .5);
  const double a = .1, rho = 2600;
  s.context.gravity = {0, 0, -9.81};
  for (int i = 0; i < blocks; ++i) s.add_block({a, a, a}, rho, {0, 0, a * (i + .5)});
  s.add_floor(1, 1);
  s.candidates = Candidates({.005, true});
  s.prepare();
  s.context.dt = .2 * 2 / std::sqrt(4 * kShaoStiffness * E * a / (rho * a * a * a));
  return s;
}

TEST(Stack, of_ten_blocks_stands) {
  Scene s = stack(10);
  s.context.local_damping = .5;
  s.run(1);
  s.context.local_damping = 0;
  s.run(10);
  for (int i = 0; i < 10; ++i) {
    EXPECT_LT(s.bodies.x[i].head<2>().norm(), 1e-6) << i;
    EXPECT_LT(s.bodies.v[i].norm(), 1e-4) << i;
    EXPECT_GT(std::abs(s.bodies.R[i].col(2).cwiseAbs().maxCoeff()), 1 - 1e-9) << i;
  }
}

// n blocks each shifted over the one below by share * L/(2k), k counted from the top.
double overhang_drop(double share) {
  const int n = 3;
  Scene s(1e9, .6);
  const Vec3 edges(.2, .2, .05);
  s.context.gravity = {0, 0, -9.81};
  double x = 0;
  for (int i = 0; i < n; ++i) {
    s.add_block(edges, 1000, {x, 0, edges.z() * (i + .5)});
    if (i + 1 < n) x += share * edges.x() / (2 * (n - 1 - i));
  }
  s.add_floor(1, 1);
  s.prepare();
  s.context.dt = .1 * 2 / std::sqrt(4 * kShaoStiffness * 1e9 * edges.x() / (1000 * .2 * .2 * .05));
  const double g = 9.81, ramp = .2;  // gravity grows slowly
  s.context.local_damping = .3;
  s.drive = [=](Scene& w) { w.context.gravity = {0, 0, -g * std::min(1., w.time / ramp)}; };
  const double z = s.bodies.x[n - 1].z();
  s.run(2);
  return z - s.bodies.x[n - 1].z();
}

TEST(Overhang, stands_within_and_falls_beyond) {
  EXPECT_LT(overhang_drop(.99), 1e-3);
  EXPECT_GT(overhang_drop(1.01), 1e-2);
}

// Far more load than one block: heavy on light, 1:1e4, soft floor; the light one is not crushed.
TEST(MassRatio, heavy_block_on_a_chip) {
  Scene s(5e10, .5);
  s.context.gravity = {0, 0, -9.81};
  s.add_block({.01, .01, .01}, 2600, {0, 0, .005});
  s.add_block({.2, .2, .25}, 2600, {0, 0, .01 + .125});
  s.add_floor(1, 1);
  s.candidates = Candidates({.001, true});
  s.prepare();
  s.context.dt = .1 * 2 / std::sqrt(4 * kShaoStiffness * 5e10 * .01 / (2600 * 1e-6));
  s.context.local_damping = .5;
  double deepest = 0;
  for (int k = 0; k < 100000; ++k) {
    s.step();
    for (const double d : s.pairs.depth) deepest = std::max(deepest, d);
  }
  EXPECT_LT(deepest, .05 * .01);
  EXPECT_LT(s.bodies.v[1].norm(), 1e-4);
}

}  // namespace
}  // namespace trackbed::dem
