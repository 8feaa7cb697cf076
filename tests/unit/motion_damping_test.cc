// Shao's adaptive global damping against its closed form; the time step rules by name.
#include <gtest/gtest.h>

#include "base/error.h"
#include "motion_scene.h"

namespace trackbed::dem {
namespace {

TEST(AdaptiveDamping, decays_exactly_and_adapts_by_the_paper) {
  Scene s(1e7, .5);
  s.context.gravity = Vec3::Zero();
  const int free = s.add_block({.1, .2, .3}, 2600, {0, 0, 0});
  const int guided = s.add_block({.1, .1, .1}, 2600, {2, 0, 0}, Quat::Identity(), kMoveX);
  s.bodies.v[free] = {1, 2, 3}, s.bodies.v[guided] = {1, 1, 0};
  set_spin(s.bodies, free, {4, 5, 6});
  s.context.dt = 1e-2;
  AdaptiveDamping d;
  const Vec3 L = s.bodies.L[free];
  const double energy = kinetic_energy(s.bodies);
  const double absorbed = damp(d, s.bodies, s.context), keep = std::exp(-.1 * 1e-2);
  EXPECT_LT((s.bodies.v[free] - keep * Vec3(1, 2, 3)).norm(), 1e-15);
  EXPECT_LT((s.bodies.L[free] - keep * L).norm(), 1e-15);
  EXPECT_EQ(s.bodies.v[guided].y(), 1);  // prescribed
  EXPECT_NEAR(absorbed, energy * (1 - keep * keep), 1e-12 * energy);
  EXPECT_EQ(d.alpha, .1);  // no change of kinetic energy is known yet
  // Nothing but damping changes the energy: R = 1.
  damp(d, s.bodies, s.context);
  EXPECT_DOUBLE_EQ(d.alpha, .1 * .99);
  // Twice as fast by other means: hardly absorbed, R < 0.5.
  s.bodies.v[free] *= 2;
  damp(d, s.bodies, s.context);
  EXPECT_DOUBLE_EQ(d.alpha, .1 * .99 * 1.1);
}

TEST(AdaptiveDamping, brings_a_block_to_rest_with_a_closed_ledger) {
  Scene s(1e7, .5);
  s.add_block({.1, .1, .1}, 2600, {0, 0, .06}, turn_about({1, 2, 0}, .3));
  s.add_floor(1, 1);
  s.adaptive = true;
  s.prepare();
  s.context.dt = .1 * expected_limit(s.bodies, s.shapes, s.materials, {}).dt;
  s.run(2);
  EXPECT_LT(kinetic_energy(s.bodies), 1e-8);
  EXPECT_GT(s.flow.local_damping, 0);
  EXPECT_LT(std::abs(s.closure()), 1e-3 * s.flow.local_damping);
}

TEST(TimeStepRules, by_name) {
  Scene s(1e9, .5);
  s.add_block({.1, .1, .1}, 2600, {0, 0, 0});
  s.add_block({.05, .05, .05}, 2600, {1, 0, 0});
  const double m = 2600 * std::pow(.05, 3);
  const double k = 4 * 1e9 / (3 * std::sqrt(M_PI)) * std::sqrt(.1 * .05 * .05);
  EXPECT_NEAR(rule_of_thumb("sun2015", s.bodies, s.shapes, s.materials),
              2 * M_PI * std::sqrt(m / k) / 40, 1e-12);
  const double r = .05 * std::cbrt(.75 / M_PI), wave = std::sqrt(1e9 / 2.6 / 2600);
  EXPECT_NEAR(rule_of_thumb("rayleigh", s.bodies, s.shapes, s.materials),
              M_PI * r / (.92553 * wave), 1e-12);
  EXPECT_THROW(rule_of_thumb("guess", s.bodies, s.shapes, s.materials), InputError);
  // Rayleigh's time is no limit for many stiff contacts: the true one is smaller.
  EXPECT_LT(expected_limit(s.bodies, s.shapes, s.materials, {}).dt,
            rule_of_thumb("rayleigh", s.bodies, s.shapes, s.materials));
}

}  // namespace
}  // namespace trackbed::dem
