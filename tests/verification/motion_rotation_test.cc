// Free rotation against theory: the flip of a body spinning about its middle axis, what it keeps,
// and the order of the splitting.
#include <gtest/gtest.h>

#include "dem/motion/motion.h"
#include "dem/motion/rotation.h"
#include "known/flip_period.h"

namespace trackbed::dem {
namespace {

double energy(const Bodies& b) { return b.omega[0].dot(b.L[0]) / 2; }

TEST(FreeRotation, flips_with_the_period_of_theory) {
  EXPECT_NEAR(flip_period(2e-4), kFlipPeriod, 1e-5);
}

TEST(FreeRotation, second_order) {
  const double e1 = std::abs(flip_period(.04) - kFlipPeriod),
               e2 = std::abs(flip_period(.02) - kFlipPeriod);
  EXPECT_NEAR(std::log2(e1 / e2), 2, .1);
}

TEST(FreeRotation, keeps_angular_momentum_and_energy_without_drift) {
  Bodies b = one_body({1, 2, 3}, {.01, 1, .01}, turn_about({1, 2, 3}, .7));
  const StepContext c = context(.01);
  const Vec3 L = b.L[0];
  const double e = energy(b);
  double early = 0, late = 0;
  for (int k = 0; k < 400000; ++k) {
    drift(b, c), kick(b, c);
    double& worst = k < 40000 ? early : late;
    worst = std::max(worst, std::abs(energy(b) - e) / e);
  }
  EXPECT_LT((b.L[0] - L).norm(), 1e-12 * L.norm());
  EXPECT_LT((world_inertia(b, 0) * b.omega[0] - L).norm(), 1e-12 * L.norm());
  EXPECT_LT(early, 1e-4);
  EXPECT_LT(late, 1.01 * early);
  EXPECT_NEAR(b.q[0].norm(), 1, 1e-14);
}

TEST(FreeRotation, turn_is_the_rotation_of_the_step) {
  Bodies b = one_body({1, 2, 3}, {3, 2, -4}, turn_about({1, 0, 1}, 1));
  const Mat3 before = b.R[0];
  drift(b, context(.05));
  EXPECT_LT((from_rotation_vector(b.turn[0]).toRotationMatrix() * before - b.R[0]).norm(), 1e-14);
}

TEST(FreeRotation, one_free_axis_turns_about_it_alone) {
  Bodies b;
  add_body(b, 0, 0, 2, {1, 2, 3}, Vec3::Zero(), turn_about({0, 0, 1}, 0), kTurnY);
  b.torque[0] = {5, 4, 3};
  b.force[0] = {1, 1, 1};
  const StepContext c = context(.01);
  for (int k = 0; k < 100; ++k) drift(b, c), kick(b, c);
  EXPECT_NEAR(b.omega[0].y(), 2, 1e-12);  // 4/2 * 1 s
  EXPECT_EQ(b.omega[0].x(), 0);
  EXPECT_EQ(b.v[0].norm(), 0);
  EXPECT_NEAR(rotation_vector(b.q[0]).y(), 1, 1e-12);  // 1/2 * 2 * 1
}

TEST(FreeFall, parabola_is_exact) {
  Bodies b = one_body({1, 1, 1}, {0, 0, 0});
  StepContext c = context(.1);
  c.gravity = {0, 0, -10};
  b.v[0] = {1, 0, 0};
  for (int k = 0; k < 10; ++k) drift(b, c), kick(b, c);
  EXPECT_NEAR(b.x[0].z(), -5, 1e-12);
  EXPECT_NEAR(b.x[0].x(), 1, 1e-12);
}

TEST(LocalDamping, takes_the_energy_that_it_reports) {
  Bodies b = one_body({1, 1, 1}, {0, 0, 0});
  StepContext c = context(.01);
  c.gravity = {0, 0, -10};
  c.local_damping = .4;
  double taken = 0;
  for (int k = 0; k < 100; ++k) taken += drift(b, c).local_damping + kick(b, c).local_damping;
  // From rest: the very first half kick is undamped, then a = 0.6 g.
  EXPECT_NEAR(b.v[0].z(), -6 - .4 * 10 * .005, 1e-12);
  const double lost = -10 * b.x[0].z() - .5 * b.v[0].squaredNorm();
  EXPECT_NEAR(taken, lost, 1e-3 * lost);
}

// A particle on a spring: Verlet is bounded just below omega dt = 2 and grows just above; the
// frequency is higher by 1 + W^2/24.
double largest_swing(double w, int steps) {
  Bodies b = one_body({1, 1, 1}, {0, 0, 0});
  const StepContext c = context(w);
  b.x[0] = {1, 0, 0};
  b.force[0] = -b.x[0];
  double most = 0;
  for (int k = 0; k < steps; ++k) {
    drift(b, c);
    b.force[0] = -b.x[0];
    kick(b, c);
    most = std::max(most, std::abs(b.x[0].x()));
  }
  return most;
}

TEST(Verlet, bounded_below_the_limit_and_growing_above) {
  EXPECT_LT(largest_swing(1.98, 100000), 1.001);
  EXPECT_GT(largest_swing(2.02, 1000), 1e6);
}

TEST(Verlet, frequency) {
  const double w = .2;
  Bodies b = one_body({1, 1, 1}, {0, 0, 0});
  const StepContext c = context(w);
  b.x[0] = {1, 0, 0};
  b.force[0] = -b.x[0];
  double before = 1, last = 0;
  int crossings = 0;
  for (int k = 1; crossings < 1001; ++k) {
    drift(b, c);
    b.force[0] = -b.x[0];
    kick(b, c);
    const double now = b.x[0].x();
    if (before > 0 && now <= 0) {
      if (++crossings == 1) last = -(k - 1 + before / (before - now)) * w;
      if (crossings == 1001) last += (k - 1 + before / (before - now)) * w;
    }
    before = now;
  }
  EXPECT_NEAR(2 * M_PI * 1000 / last, 1 + w * w / 24, 1e-5);
}

}  // namespace
}  // namespace trackbed::dem
