// Torsion and rolling resistance: closed forms of the spring, its limit, its energy; a stack whose
// blocks are offset does not turn; off leaves no trace.
#include <gtest/gtest.h>

#include "dem/contact/friction.h"
#include "dem/contact/resistance.h"
#include "motion_scene.h"

namespace trackbed::dem {
namespace {

// Two bodies with one touching pair whose normal force, area and arms are given by hand.
struct OnePair {
  Scene s{1e7, .5};
  const double force = 100, area = 1e-4, ra = .02, rb = .03, kn = 1e6, dt = 1e-3;

  OnePair() {
    s.add_block({.04, .04, .04}, 2600, {0, 0, 0});
    s.add_block({.06, .06, .06}, 2600, {0, 0, .05});
    s.context.dt = dt;
    Pairs& p = s.pairs;
    p.resize(1);
    p.a[0] = 0, p.b[0] = 1;
    p.index_bodies(2);
    p.touching[0] = 1;
    p.axis[0] = Vec3(0, 0, 1);
    p.normal_force[0] = force;
    p.area[0] = area, p.stiffness[0] = kn;
    p.arm_a[0] = Vec3(0, 0, ra), p.arm_b[0] = Vec3(0, 0, -rb);
  }
  // One step in which a turns by `turn` against b; the moment on a.
  Vec3 step(const ResistanceSettings& r, const Vec3& turn) {
    s.bodies.turn[0] = turn;
    s.pairs.couple[0].setZero();
    s.pairs.friction_energy[0] = s.pairs.friction_loss[0] = 0;
    add_resistance(r, s.bodies, s.materials, s.context, s.pairs);
    return s.pairs.couple[0];
  }
};

TEST(Torsion, is_a_spring_up_to_coulombs_limit) {
  OnePair pair;
  ResistanceSettings r;
  r.torsion = 1;
  const double kt = .25 * 4 * 1e7 / (3 * std::sqrt(M_PI)) * std::sqrt(pair.area);
  const double k = kt * pair.area / (2 * M_PI);
  const double limit = .5 * pair.force * 2. / 3 * std::sqrt(pair.area / M_PI);
  // Evenly pressed disc: mu p int r dA = mu F (2 pi a^3/3)/(pi a^2), the same limit.
  const double a = std::sqrt(pair.area / M_PI);
  EXPECT_NEAR(limit, .5 * pair.force / (M_PI * a * a) * (2 * M_PI * a * a * a / 3), 1e-15);
  pair.step(r, Vec3::Zero());  // new contact: its spring starts here
  const double turn = .1 * limit / k;
  double stored = 0, lost = 0, work = 0, before = 0;
  for (int n = 1; n <= 20; ++n) {
    const double m = pair.step(r, Vec3(0, 0, turn)).z();
    EXPECT_NEAR(m, -std::min(n * .1, 1.) * limit, 1e-12 * limit) << n;
    work += -(before + m) / 2 * turn;
    before = m;
    stored = pair.s.pairs.friction_energy[0], lost += pair.s.pairs.friction_loss[0];
  }
  EXPECT_NEAR(stored, limit * limit / (2 * k), 1e-12 * stored);
  EXPECT_NEAR(work, stored + lost, 1e-12 * work);
  EXPECT_LT(pair.step(r, Vec3(.1, .2, 0)).head<2>().norm(), 1e-15);  // about the normal only
}

// Ai et al. 2011, model C: M = k_r theta up to mu_r R F, unloading along the same slope.
TEST(Rolling, is_elastic_plastic) {
  OnePair pair;
  ResistanceSettings r;
  r.rolling = .3;
  const double R = pair.ra * pair.rb / (pair.ra + pair.rb), limit = r.rolling * R * pair.force;
  const double k = 2.25 * pair.kn * r.rolling * r.rolling * R * R, turn = .25 * limit / k;
  pair.step(r, Vec3::Zero());
  for (int n = 1; n <= 8; ++n)
    EXPECT_NEAR(pair.step(r, Vec3(turn, 0, 0)).x(), -std::min(.25 * n, 1.) * limit, 1e-9 * limit)
        << n;
  for (int n = 1; n <= 12; ++n)
    EXPECT_NEAR(pair.step(r, Vec3(-turn, 0, 0)).x(), std::min(-1 + .25 * n, 1.) * limit,
                1e-3 * limit)
        << n;
  EXPECT_NEAR(pair.step(r, Vec3(0, 0, .1)).z(), 0, 1e-15);
  pair.s.pairs.touching[0] = 0;
  pair.step(r, Vec3::Zero());
  EXPECT_EQ(pair.s.pairs.rolling[0], Vec3::Zero());
}

// Blocks offset by 10 mm: the pressure on the overlap's flanks has a moment about the vertical,
// tiny (1e-6 of weight times size) but for ever. Without torsion nothing holds against it.
double largest_spin(double torsion) {
  Scene s(1e9, .6);
  const double edge = .1;
  for (int i = 0; i < 4; ++i)
    s.add_block({edge, edge, edge}, 2600, {.01 * (i % 2), 0, edge * (i + .5)});
  s.add_floor(1, 1);
  s.resistance.torsion = torsion;
  s.prepare();
  s.context.dt = .2 * 2 / std::sqrt(4 * kShaoFactor * 1e9 / (2600 * edge * edge));
  s.context.local_damping = .5;
  s.run(.5);
  s.prepare();
  s.context.local_damping = 0;
  s.run(1.5);
  EXPECT_LT(std::abs(s.closure()), 1e-10);  // no energy comes from nowhere either way
  double most = 0;
  for (int i = 0; i < 4; ++i) most = std::max(most, std::abs(s.bodies.omega[i].z()));
  return most;
}

// Without friction nothing else writes what the springs add to: it must not pile up step by step.
TEST(Rolling, of_frictionless_spheres_stores_its_own_energy_only) {
  Scene s(1e7, 0);
  s.resistance.rolling = .1;
  s.add(sphere_shape(.02), 2600, {0, 0, 0});
  s.add(sphere_shape(.02), 2600, {0, 0, .0399});
  s.prepare();
  ASSERT_EQ(count_contacts(s.pairs), 1);
  s.bodies.turn[0] = Vec3(1e-5, 0, 0);
  for (int n = 0; n < 5; ++n) {
    s.evaluate_pairs(1e-5);
    s.bodies.turn[0].setZero();
    const double expected = s.pairs.rolling[0].squaredNorm() / (2 * s.pairs.rolling_stiffness[0]);
    EXPECT_GT(expected, 0);
    EXPECT_NEAR(s.pairs.friction_energy[0], expected, 1e-12 * expected) << n;
    EXPECT_EQ(s.pairs.friction_loss[0], 0);
  }
  // Nothing but the spring turns them: centred forces of frictionless spheres have no arm.
  sum_forces(s.pairs, s.context, s.bodies);
  const Vec3 spring = s.pairs.rolling[0];
  EXPECT_LT((s.bodies.torque[0] - spring).norm(), 1e-12 * spring.norm());
  EXPECT_LT((s.bodies.torque[1] + spring).norm(), 1e-12 * spring.norm());
}

TEST(Torsion, keeps_an_offset_stack_from_turning) {
  EXPECT_GT(largest_spin(0), 1e-3);
  EXPECT_LT(largest_spin(1), 1e-6);
}

TEST(Resistance, off_has_no_arrays) {
  Scene s(1e7, .5);
  s.add_block({.1, .1, .1}, 2600, {0, 0, .05});
  s.add_floor(1, 1);
  s.prepare();
  s.context.dt = 1e-5;
  for (int k = 0; k < 10; ++k) s.step();
  EXPECT_FALSE(s.pairs.resists);
  EXPECT_TRUE(s.pairs.torsion.empty() && s.pairs.rolling.empty());
}

}  // namespace
}  // namespace trackbed::dem
