// Bodies and contacts are taken eight at a time: each one moves as it does alone, whatever goes
// with it.
#include <gtest/gtest.h>

#include <numeric>

#include "motion_scene.h"

namespace trackbed::dem {
namespace {

void add_number(Bodies& b, int k) {
  // Eight free ones, eight spheres, then some that are held; one of them turns fast.
  const bool sphere = k % 3 == 0 || (k >= 8 && k < 16);
  const std::uint8_t freedom = k >= 16 && k % 7 == 3   ? kMoveZ | kTurnX | kTurnY | kTurnZ
                               : k >= 16 && k % 7 == 5 ? kFixed
                                                       : kFree;
  const Vec3 inertia = sphere ? Vec3(2, 2, 2) : Vec3(1, 2. + .1 * k, 2.5);
  const int i = add_body(b, 0, 0, 1 + .1 * k, inertia, Vec3(k, 0, 0),
                         turn_about({1, 2. * k, -1}, .3 * k), freedom);
  b.v[i] = Vec3(.1 * k, -1, .5);
  b.force[i] = Vec3(3, -2. * k, 1), b.torque[i] = Vec3(1, .5, -.2 * k);
  b.applied_force[i] = Vec3(.1, .2, k);
  set_spin(b, i, k == 4 ? Vec3(300, 10, -200) : Vec3(1, -.3 * k, .5));
}

TEST(Together, bodies_move_as_they_do_alone) {
  for (const double damping : {0., .4}) {
    StepContext c;
    c.dt = .01, c.local_damping = damping;
    const int n = 35;
    Bodies all;
    for (int k = 0; k < n; ++k) add_number(all, k);
    StepWork sum, expected;
    for (int step = 0; step < 5; ++step) sum += drift(all, c), sum += kick(all, c);
    for (int k = 0; k < n; ++k) {
      Bodies one;
      add_number(one, k);
      for (int step = 0; step < 5; ++step) expected += drift(one, c), expected += kick(one, c);
      EXPECT_LT((one.x[0] - all.x[k]).norm(), 1e-13) << k;
      EXPECT_LT((one.v[0] - all.v[k]).norm(), 1e-13) << k;
      EXPECT_LT((one.omega[0] - all.omega[k]).norm(), 1e-12 * one.omega[0].norm()) << k;
      EXPECT_LT((one.turn[0] - all.turn[k]).norm(), 1e-12) << k;
      EXPECT_LT((one.q[0].coeffs() - all.q[k].coeffs()).norm(), 1e-12) << k;
      EXPECT_LT((one.R[0] - all.R[k]).norm(), 1e-12) << k;
      EXPECT_LT((all.R[k] - all.q[k].toRotationMatrix()).norm(), 1e-14) << k;
    }
    EXPECT_NEAR(sum.applied, expected.applied, 1e-12 * std::abs(expected.applied));
    EXPECT_NEAR(sum.prescribed, expected.prescribed, 1e-12 * std::abs(expected.prescribed));
    EXPECT_NEAR(sum.local_damping, expected.local_damping, 1e-12 * expected.local_damping);
  }
}

// Two grains that meet obliquely, spinning: a sphere with a sphere, a clump, or a block.
GrainShape shape(int k) {
  if (k % 3 == 1)
    return as_grain(make_clump_shape({{{.01, 0, 0}, .02}, {{-.01, .004, 0}, .015 + .0003 * k}}));
  if (k % 3 == 2) return make_grain_shape(make_box({.03, .04 + .001 * k, .05}));
  return sphere_shape(.02 + .0005 * k);
}

Scene scene() {
  Scene s(1e7, .4);
  s.materials = PairMaterials(2);
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j <= i; ++j) {
      PairMaterial m;
      m.modulus = 1e7 * (1 + i + j), m.friction = .3 + .1 * i, m.tangential_ratio = .25;
      m.damping = .2 * (1 + j);
      s.materials.set(i, j, m);
    }
  s.context.gravity.setZero();
  return s;
}

void add_two(Scene& s, int k) {
  const Vec3 at(.2 * k, .01 * k, 0);
  const int i = s.add(sphere_shape(.02), 2600, at);
  const int j = s.add(shape(k), 2600, at + Vec3(.008, .003, .05 + .0002 * k),
                      turn_about({1, .5, .2}, .4 * k), k == 12 ? kFixed : kFree);
  s.bodies.material[i] = k % 2, s.bodies.material[j] = k / 2 % 2;
  s.bodies.v[i] = Vec3(.3, .1, 4), set_spin(s.bodies, i, {20, -30, 5. * k});
}

void run(Scene& s) {
  s.context.dt = 5e-6;
  s.prepare();
  for (int k = 0; k < 1500; ++k) s.step();
}

// Whole numbers, whose sum has no rounding; rows of eight and what is left over, one block and many.
TEST(Together, losses_are_summed_whole) {
  for (const int n : {0, 1, 7, 8, 9, 64, 1000, 30001}) {
    Pairs pairs;
    pairs.resize(n);
    std::iota(pairs.friction_loss.begin(), pairs.friction_loss.end(), 1.);
    for (const int threads : {1, 2})
      EXPECT_EQ(friction_loss(pairs, threads), .5 * n * (n + 1.)) << n;
  }
}

TEST(Together, contacts_answer_as_they_do_alone) {
  const int n = 60;  // rows of eight that touch, of spheres and of clumps, and some left over
  Scene all = scene();
  for (int k = 0; k < n; ++k) add_two(all, k);
  run(all);
  int changed = 0;
  for (int k = 0; k < n; ++k) {
    Scene one = scene();
    add_two(one, k);
    const Vec3 before = one.bodies.v[0];
    run(one);
    changed += (one.bodies.v[0] - before).norm() > .1;
    for (int i = 0; i < 2; ++i) {
      EXPECT_LT((one.bodies.v[i] - all.bodies.v[2 * k + i]).norm(), 1e-10) << k;
      EXPECT_LT((one.bodies.omega[i] - all.bodies.omega[2 * k + i]).norm(), 1e-8) << k;
      EXPECT_LT((one.bodies.x[i] - all.bodies.x[2 * k + i]).norm(), 1e-12) << k;
    }
  }
  EXPECT_GT(changed, n / 2);
}

// Spheres, clumps and blocks, pressed together in a container: all kinds of pairs, many of each.
Scene heap(int row, int steps, int threads) {
  Scene s(1e7, .4);
  PairMaterial m = s.materials(0, 0);
  m.damping = .3;
  s.materials.set(0, 0, m);
  const double cell = .039;
  for (int i = 0; i < row * row * row; ++i) {
    const Vec3 at(i % row + .5, i / row % row + .5, i / (row * row) + .5);
    s.add(shape(i % 4 == 3    ? 1
                : i % 11 == 5 ? 2
                              : 0),
          2600, cell * at, turn_about({1, .5 * i, .2}, .4 * i));
  }
  add_container(s.bodies, s.shapes, {0, 0, 0}, cell * row * Vec3(1, 1, 2), .1, 0);
  s.context.threads = threads, s.context.local_damping = .1, s.context.dt = 1e-5;
  s.prepare();
  s.run(steps * s.context.dt);
  return s;
}

TEST(Together, the_same_bits_on_any_threads) {
  // Both are large enough for all passes to be shared.
  for (const auto& [row, steps] : {std::pair(7, 300), std::pair(14, 20)}) {
    const Scene one = heap(row, steps, 1);
    for (const PairKind k : {PairKind::balls, PairKind::points, PairKind::point_core})
      EXPECT_GT(one.pairs.end(k) - one.pairs.begin(k), 200);
    EXPECT_GT(count_contacts(one.pairs), 500);
    StepContext two;
    two.threads = 2;
    EXPECT_EQ(two.threads_for(one.bodies.size()), 2);
    for (const PairKind k : {PairKind::balls, PairKind::points, PairKind::point_core})
      EXPECT_EQ(two.threads_for(one.pairs.end(k) - one.pairs.begin(k)), 2);
    for (const int threads : {2, 8}) {
      const Scene s = heap(row, steps, threads);
      EXPECT_EQ(one.flow.total(), s.flow.total()) << threads;
      EXPECT_EQ(one.bodies.x, s.bodies.x) << threads;
      EXPECT_EQ(one.bodies.L, s.bodies.L) << threads;
      EXPECT_EQ(one.pairs.friction, s.pairs.friction) << threads;
      EXPECT_EQ(one.candidates.travel(), s.candidates.travel()) << threads;
    }
  }
}

}  // namespace
}  // namespace trackbed::dem
