// Many grains at once: momentum, energy ledger, the same bits for any thread count and after a
// restart, time step limits.
#include <gtest/gtest.h>

#include <cstring>
#include <random>

#include "base/error.h"
#include "dem/motion/monitor.h"
#include "motion_scene.h"

namespace trackbed::dem {
namespace {

constexpr double kModulus = 2e8;

// Random hulls in a loose grid above the origin.
void add_grains(Scene& s, int n, int seed, double spacing = 1.05) {
  const double size = .04;
  std::mt19937 random(seed);
  const auto u = [&] { return random() / 2147483648. - 1; };
  const int row = static_cast<int>(std::ceil(std::cbrt(n)));
  std::vector<int> shapes;
  for (int k = 0; k < 12; ++k) {
    std::vector<Vec3> points;
    while (points.size() < 14) {
      const Vec3 p(u(), u(), u());
      if (p.norm() < 1 && p.norm() > .1) points.push_back(size / 2 * p.normalized());
    }
    shapes.push_back(s.shapes.add(make_grain_shape(convex_hull(points))));
  }
  for (int i = 0; i < n; ++i) {
    const Vec3 x(i % row, i / row % row, i / (row * row));
    add_grain(s.bodies, s.shapes, shapes[i % shapes.size()], 0, 2600,
              spacing * size * (x + Vec3(.5, .5, .5)), turn_about({u(), u(), u()}, 3 * u()));
  }
}

// In a box; a spacing below 1 starts with grains that touch.
Scene pile(int n, double mu, int seed = 1, double spacing = 1.05) {
  Scene s(kModulus, mu);
  s.context.gravity = {0, 0, -9.81};
  add_grains(s, n, seed, spacing);
  const double width = 1.05 * .04 * std::ceil(std::cbrt(n));
  add_container(s.bodies, s.shapes, {0, 0, 0}, {width, width, 10 * width}, .05, 0);
  s.prepare();
  ContactExpectation expect;
  s.context.dt = .1 * expected_limit(s.bodies, s.shapes, s.materials, expect).dt;
  return s;
}

TEST(Pile, momentum_is_kept_without_outer_load) {
  Scene s(kModulus, .6);
  s.context.gravity.setZero();
  add_grains(s, 64, 3);
  for (int i = 0; i < 64; ++i) {
    s.bodies.v[i] = 20 * (Vec3(.084, .084, .084) - s.bodies.x[i]);  // fly to the middle
    set_spin(s.bodies, i, Vec3(10, i % 5, -i % 7));
  }
  s.prepare();
  s.context.dt = .05 * expected_limit(s.bodies, s.shapes, s.materials, {}).dt;
  const auto momentum = [&](Vec3& p, Vec3& l, double& scale_p, double& scale_l) {
    p.setZero(), l.setZero(), scale_p = scale_l = 0;
    for (int i = 0; i < 64; ++i) {
      const Vec3 mv = s.bodies.mass[i] * s.bodies.v[i];
      const Vec3 li = s.bodies.L[i] + s.bodies.x[i].cross(mv);
      p += mv, l += li, scale_p += mv.norm(), scale_l += li.norm();
    }
  };
  Vec3 p0, l0, p, l;
  double sp, sl, x;
  momentum(p0, l0, sp, sl);
  int most = 0;
  for (int k = 0; k < 3000; ++k) s.step(), most = std::max(most, count_contacts(s.pairs));
  EXPECT_GT(most, 30);
  momentum(p, l, x, x);
  EXPECT_LT((p - p0).norm(), 1e-12 * sp);
  EXPECT_LT((l - l0).norm(), 1e-12 * sl);
}

// Deposit under gravity: what came from nowhere, against the work that gravity did.
double ledger(double mu, double share, double damping) {
  Scene s = pile(27, mu);
  s.context.dt = share * expected_limit(s.bodies, s.shapes, s.materials, {}).dt;
  s.context.local_damping = damping;
  int most = 0;
  while (s.time < .15) s.step(), most = std::max(most, count_contacts(s.pairs));
  EXPECT_GT(most, 8);
  EXPECT_EQ(s.flow.friction > 0, mu > 0);
  EXPECT_EQ(s.flow.local_damping > 0, damping > 0);
  const double fall = s.start.gravity - s.now().gravity;
  EXPECT_GT(fall, 0);
  return s.closure() / fall;
}

TEST(Ledger, closes_with_friction) { EXPECT_LT(std::abs(ledger(.6, .05, 0)), 2e-4); }
TEST(Ledger, closes_with_local_damping) { EXPECT_LT(std::abs(ledger(.6, .05, .4)), 1e-3); }
TEST(Ledger, closes_without_friction) { EXPECT_LT(std::abs(ledger(0, .05, 0)), 2e-5); }

// Two grains meet head-on, elastic and frictionless: smooth, so that the order shows.
double bounce(double share) {
  Scene s(kModulus, 0);
  s.context.gravity.setZero();
  add_grains(s, 2, 5);
  s.bodies.v[0] = {.2, .01, 0};
  s.bodies.v[1] = {-.2, 0, .01};
  s.bodies.x[1] = s.bodies.x[0] + Vec3(.041, .002, .003);
  s.prepare();
  s.context.dt = share * expected_limit(s.bodies, s.shapes, s.materials, {}).dt;
  const double kinetic = s.start.kinetic;
  double worst = 0;
  bool touched = false;
  while (s.time < .1) {
    s.step();
    touched |= count_contacts(s.pairs) > 0;
    worst = std::max(worst, std::abs(s.closure()) / kinetic);
  }
  EXPECT_TRUE(touched);
  return worst;
}

TEST(Ledger, elastic_and_frictionless_closes_with_second_order) {
  const double e1 = bounce(.04), e2 = bounce(.01), e3 = bounce(.0025);
  EXPECT_LT(e3, 1e-6);
  EXPECT_GT(std::log(e1 / e3) / std::log(16.), 1.6) << e1 << " " << e2 << " " << e3;
}

TEST(Ledger, prescribed_plate_and_applied_force) {
  Scene s = pile(27, .5);
  const double w = 1.05 * .04 * 3;
  const int plate =
      add_box(s.bodies, s.shapes, {.001, .001, w}, {w - .001, w - .001, w + .02}, 0, 1, kFixed);
  const int lid = add_box(s.bodies, s.shapes, {-.05, -.05, -.3}, {w, w, -.2}, 0, 2, kMoveZ);
  s.bodies.v[plate] = {0, 0, -.35};
  s.bodies.applied_force[lid] = {0, 0, 2 * 9.81 + 3};
  s.bodies.x[lid].z() = -5;  // free of all: pure work of a force, 1.5 m/s2
  s.prepare();
  s.context.dt = .1 * expected_limit(s.bodies, s.shapes, s.materials, {}).dt;
  s.run(.25);
  EXPECT_GT(s.flow.prescribed, 0);
  EXPECT_NEAR(s.flow.applied, (2 * 9.81 + 3) * .5 * 1.5 * .25 * .25, 1e-3 * s.flow.applied);
  EXPECT_NEAR(s.bodies.x[plate].z(), w + .01 - .35 * .25, 1e-4);
  EXPECT_LT(std::abs(s.closure()), 1e-3 * (s.flow.prescribed + s.flow.applied));
}

std::vector<unsigned char> bits(const Scene& s) {
  std::vector<unsigned char> all;
  const auto add = [&](const auto& v) {
    const auto* p = reinterpret_cast<const unsigned char*>(v.data());
    all.insert(all.end(), p, p + v.size() * sizeof(v[0]));
  };
  add(s.bodies.x), add(s.bodies.q), add(s.bodies.v), add(s.bodies.L), add(s.bodies.force);
  add(s.pairs.friction), add(s.pairs.energy);
  const double sums[] = {s.closure(), s.flow.friction, s.flow.local_damping};
  all.insert(all.end(), reinterpret_cast<const unsigned char*>(sums),
             reinterpret_cast<const unsigned char*>(sums + 3));
  return all;
}

TEST(Pile, same_bits_for_1_2_8_threads_and_run_to_run) {
  std::vector<unsigned char> first;
  for (const int threads : {1, 2, 8, 1}) {
    Scene s = pile(64, .6, 1, .9);
    s.context.threads = threads;
    s.context.local_damping = .2;
    EXPECT_GT(count_contacts(s.pairs), 30);
    for (int k = 0; k < 1000; ++k) s.step();
    if (first.empty())
      first = bits(s);
    else
      EXPECT_EQ(bits(s), first) << threads << " threads";
  }
}

TEST(Pile, resumed_is_the_uninterrupted_run) {
  Scene a = pile(64, .6, 1, .9);
  for (int k = 0; k < 700; ++k) a.step();
  // Through the arrays that a checkpoint holds, nothing else.
  Scene b = pile(64, .6, 1, .9);
  b.bodies = a.bodies, b.context = a.context, b.start = a.start, b.flow = a.flow, b.time = a.time;
  std::vector<std::vector<unsigned char>> saved;
  for_each_array(a.pairs, [&](const char*, auto& v) {
    const auto* p = reinterpret_cast<const unsigned char*>(v.data());
    saved.emplace_back(p, p + v.size() * sizeof(v[0]));
  });
  b.pairs = Pairs();
  b.pairs.resize(a.pairs.size());
  std::size_t k = 0;
  for_each_array(b.pairs, [&](const char*, auto& v) {
    ASSERT_EQ(saved[k].size(), v.size() * sizeof(v[0]));
    std::memcpy(static_cast<void*>(v.data()), saved[k].data(), saved[k].size());
    ++k;
  });
  b.pairs.index_bodies(b.bodies.size());
  b.candidates.restore(a.candidates.state());
  for (int j = 0; j < 700; ++j) a.step(), b.step();
  EXPECT_EQ(bits(a), bits(b));
}

// The measured bound is a bound: a deposited pile goes on without damping at 0.8 of it and gains no
// energy to speak of; far above it, it explodes.
TEST(TimeStep, measured_limit_holds) {
  Scene s = pile(27, .6);
  s.context.local_damping = .7;
  s.context.dt *= 3;
  s.run(.6);
  s.context.local_damping = 0;
  const TimeStepLimit limit = measured_limit(s.bodies, s.pairs, 1);
  ASSERT_GE(limit.body, 0);
  EXPECT_GT(limit.contacts, 1);
  double lift = 0;  // of all grains by a tenth of their size
  for (int i = 0; i < s.bodies.grains; ++i) lift += s.bodies.mass[i] * 9.81 * .004;
  const auto gain = [&](double share) {
    Scene t = s;
    t.context.dt = share * limit.dt;
    const double before = t.closure();
    double most = 0;
    for (int k = 0; k < 4000 && most < 10 * lift; ++k) {
      t.step();
      most = std::max(most, t.closure() - before);
    }
    return most;
  };
  EXPECT_LT(gain(.8), lift);
  EXPECT_GT(gain(4), 10 * lift);
}

TEST(TimeStep, expected_limit_is_below_the_measured_one) {
  Scene s = pile(27, .6);
  s.context.local_damping = .7;
  s.context.dt *= 3;
  s.run(.5);
  const double expected = expected_limit(s.bodies, s.shapes, s.materials, {}).dt;
  const double measured = measured_limit(s.bodies, s.pairs, 1).dt;
  EXPECT_LT(expected, measured);
  EXPECT_GT(expected, measured / 10);
}

std::string complaint(const Scene& s, const StateLimits& limits = {}) {
  try {
    check_state(s.bodies, s.shapes, s.pairs, s.context, 42, limits, "deposit, 0.1 s");
  } catch (const StateFault& e) {
    return e.what();
  }
  return "";
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(Monitor, names_step_grain_and_cause) {
  Scene s = pile(8, .5);
  EXPECT_EQ(complaint(s), "");
  Scene lost = s;
  lost.bodies.v[3].x() = NAN;
  EXPECT_TRUE(contains(complaint(lost), "step 42 (deposit, 0.1 s): grain 3"));
  Scene out = s;
  out.bodies.x[2].z() = -3;
  StateLimits limits;
  limits.region.low = {0, 0, 0};
  EXPECT_TRUE(contains(complaint(out, limits), "grain 2 has left the scene"));
  Scene deep = s;
  deep.bodies.x[1] = deep.bodies.x[0] + Vec3(.012, 0, 0);
  deep.prepare();
  EXPECT_TRUE(contains(complaint(deep), "grain 0 and grain 1 overlap"));
  for (const Scene* faulty : {&lost, &deep})
    EXPECT_TRUE(contains(complaint(*faulty), "Likely cause: ") &&
                contains(complaint(*faulty), "Remedy: "));
}

TEST(Monitor, stops_what_flies_off) {
  Scene s = pile(8, .5);
  s.bodies.v[5] = {0, 3, 4};
  StateLimits limits;
  limits.speed = {4.9, 0};
  EXPECT_TRUE(contains(complaint(s, limits), "grain 5 flies off"));
  // A contact may give it sqrt(2 U/m): 0.2 m/s here.
  limits.speed.energy = .02 * s.bodies.mass[5];
  EXPECT_EQ(complaint(s, limits), "");
  s.bodies.v[5] *= 1.03;
  EXPECT_TRUE(contains(complaint(s, limits), "at most 5.1 m/s"));
  // A tenth of its size in a step, whatever the limit.
  s.context.dt = 1;
  EXPECT_TRUE(contains(complaint(s), "of its size in a step"));
}

// What lies wholly inside another feels no force, whatever the shape: refused before the first
// step.
TEST(Monitor, refuses_bodies_inside_each_other) {
  const GrainShape cube = make_grain_shape(make_box(Vec3::Constant(.1)));
  const GrainShape plate = make_grain_shape(make_box({.05, .05, .001}));
  const GrainShape small = make_grain_shape(make_box(Vec3::Constant(.02)));
  const GrainShape ball = as_grain(make_clump_shape({{Vec3::Zero(), .01}}));
  const GrainShape clump =
      as_grain(make_clump_shape({{Vec3::Zero(), .01}, {Vec3(.008, 0, 0), .008}}));
  const GrainShape round = as_grain(make_dilated_shape({make_box(Vec3::Constant(.016)), .002}));
  const GrainShape big_ball = as_grain(make_clump_shape({{Vec3::Zero(), .08}}));
  const GrainShape big_round = as_grain(make_dilated_shape({make_box(Vec3::Constant(.09)), .01}));
  for (const GrainShape* outer : {&cube, &big_ball, &big_round})
    for (const GrainShape* inner : {&small, &plate, &ball, &clump, &round})
      for (const Vec3& off : {Vec3(0, 0, 0), Vec3(.003, .001, -.002)}) {
        Scene s(2e8, .5);
        s.add(*outer, 2600, Vec3::Zero());
        s.add(*inner, 2600, off, turn_about({.1, .5, .3}, .4));
        s.context.dt = 1e-5;
        s.prepare();
        EXPECT_NE(complaint(s), "") << outer->volume << ' ' << inner->volume << ' ' << off.x();
      }
}

}  // namespace
}  // namespace trackbed::dem
