// Walls that keep a force, against what the equations of the servo say.
#include <gtest/gtest.h>

#include <cmath>

#include "coupling/edit.h"
#include "coupling/world.h"
#include "dem/surface/rigid.h"
#include "dem/surface/servo.h"

namespace trackbed {
namespace {

using dem::Vec3;

// The servo's plant as one spring K' behind a wall whose contact has the stiffness K.
double error_after(int steps, double softer, double away, double& overshoot) {
  const double K = 1e8, dt = 1e-5, target = 1e3;
  double drift = 0, force = 0;
  overshoot = 0;
  for (int k = 0; k < steps; ++k) {
    const double v = dem::servo_speed(target, force, K, dt, 1e9, drift);
    force += K / softer * (v - away) * dt;
    overshoot = std::max(overshoot, force / target - 1);
  }
  return force / target - 1;
}

TEST(Servo, OnASpringIsGeometric) {
  // Without drift the error is halved each step; the drift adds a slow tail of about 1/(a n).
  double overshoot = 0;
  EXPECT_NEAR(error_after(1, 1, 0, overshoot), -0.5 + 0.5 / 200, 1e-12);
  EXPECT_NEAR(error_after(2, 1, 0, overshoot), -0.25, 5e-3);
  EXPECT_LT(std::abs(error_after(20000, 1, 0, overshoot)), 1e-9);
  EXPECT_LT(overshoot, 0.02);
}

TEST(Servo, DoesNotSwingOnSofterAssemblies) {
  // Second order: s^2 + a/(dt softer) s + a/(n dt^2 softer) has real roots while softer <= a n/4
  // = 25. The zero of the servo lets the force pass its target once; it does not swing through
  // again.
  double overshoot = 0;
  for (const double softer : {2., 10., 25.}) {
    EXPECT_LT(std::abs(error_after(40000, softer, 0, overshoot)), 1e-6) << softer;
    EXPECT_LT(overshoot, 0.2) << softer;
  }
}

TEST(Servo, FollowsASteadyRetreatWithoutError) {
  double overshoot = 0;
  EXPECT_LT(std::abs(error_after(40000, 1, 0.05, overshoot)), 1e-9);
  EXPECT_LT(std::abs(error_after(80000, 20, 0.05, overshoot)), 1e-6);
}

TEST(Servo, NeverExceedsItsSpeed) {
  double drift = 0;
  EXPECT_EQ(dem::servo_speed(1e6, 0, 1e3, 1e-5, 0.3, drift), 0.3);
  EXPECT_EQ(dem::servo_speed(0, 1e6, 1e3, 1e-5, 0.3, drift), -0.3);
  EXPECT_EQ(dem::servo_speed(1e6, 0, 0, 1e-5, 0.3, drift), 0.3);  // nothing touched
  EXPECT_EQ(drift, 0);  // it does not wind up at the limit
}

// A free cube on a held floor, a servo wall above it: the floor carries target and weight, and
// every joule that the wall brings in is accounted for.
TEST(Servo, PressesACubeWithItsForce) {
  coupling::World w;
  dem::PairMaterial m;
  m.modulus = 1e8, m.friction = 0.5, m.tangential_ratio = 0.25;
  w.materials = dem::PairMaterials(1);
  w.materials.set(0, 0, m);
  w.pair_forces = dem::make_pair_forces("stored_energy", true);
  const dem::GrainShape cube = dem::make_grain_shape(dem::make_box(Vec3::Constant(0.1)));
  coupling::add_grains(w, {cube}, {Vec3(0, 0, 0.05)}, {dem::Quat::Identity()}, 2600, 0);
  const int floor =
      dem::add_box(w.bodies, w.shapes, {-.2, -.2, -.1}, {.2, .2, 0}, 0, 1, dem::kFixed);
  const int wall =
      dem::add_box(w.bodies, w.shapes, {-.2, -.2, .1001}, {.2, .2, .2}, 0, 1, dem::kFixed);
  dem::StepContext c;
  c.dt = 0;
  coupling::prepare(w, c);
  coupling::open_ledger(w, c.gravity);
  c.dt = 2e-5, c.local_damping = 0.3;
  const double target = 400;
  double drift = 0;
  for (int k = 0; k < 40000; ++k) {
    coupling::advance(w, c, [](coupling::World&, double) {});
    const double stiffness = dem::wall_stiffness(w.pairs, wall, Vec3::UnitZ());
    const double v =
        dem::servo_speed(target, w.bodies.force[wall].z(), stiffness, c.dt, 0.1, drift);
    w.bodies.v[wall].z() = -v;
  }
  const double weight = 2600 * 1e-3 * 9.81;
  EXPECT_NEAR(w.bodies.force[wall].z(), target, 1e-6 * target);
  EXPECT_NEAR(w.bodies.force[floor].z(), -target - weight, 1e-6 * target);
  // Face on face: k_n = 2 c E sqrt(A), c = 2/(3 sqrt(pi)), and the law's own margin of 1.2.
  const double face = 2 * 2 / (3 * std::sqrt(M_PI)) * 1e8 * 0.1;
  EXPECT_NEAR(dem::wall_stiffness(w.pairs, wall, Vec3::UnitZ()), 1.2 * face, 1e-3 * face);
  EXPECT_NEAR(dem::wall_stiffness(w.pairs, wall, Vec3::UnitX()), 0, 1e-6 * face);
  const coupling::EnergyFlows f = coupling::flows(w);
  EXPECT_GT(f.prescribed, 0);
  EXPECT_LT(std::abs(coupling::closure(w.start, coupling::stores(w, c.gravity), f)),
            1e-3 * f.prescribed);
}

}  // namespace
}  // namespace trackbed
