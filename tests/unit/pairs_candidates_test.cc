// The candidate search against all pairs; history; periodic images.
#include <gtest/gtest.h>

#include <random>
#include <set>

#include "base/error.h"
#include "motion_scene.h"

namespace trackbed::dem {
namespace {

void random_blocks(Scene& s, int n, double box, int seed, double least = .02, double most = .06) {
  std::mt19937 random(seed);
  const auto uniform = [&](double a, double b) { return a + (b - a) * (random() / 4294967296.); };
  for (int i = 0; i < n; ++i) {
    const Vec3 edges(uniform(least, most), uniform(least, most), uniform(least, most));
    const Vec3 x(uniform(0, box), uniform(0, box), uniform(0, box));
    const Vec3 axis(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
    s.add_block(edges, 2600, x, turn_about(axis, uniform(0, 3)));
  }
}

using Contacts = std::set<std::pair<int, int>>;

Contacts touching_pairs(const Scene& s) {
  Contacts found;
  for (int p = 0; p < s.pairs.size(); ++p)
    if (s.pairs.touching[p]) found.insert({s.pairs.a[p], s.pairs.b[p]});
  return found;
}

Contacts all_pairs(const Scene& s) {
  Contacts found;
  const Bodies& b = s.bodies;
  for (int i = 0; i < b.size(); ++i)
    for (int j = i + 1; j < b.size(); ++j) {
      if (b.freedom[i] == kFixed && b.freedom[j] == kFixed) continue;
      const Vec3 shift = nearest_image(b.x[i], b.x[j], s.context.period);
      Vec3 axis = Vec3::Zero();
      if (separating_axis(s.shapes.view(b.shape[i]), {b.R[i], b.x[i]}, s.shapes.view(b.shape[j]),
                          {b.R[j], b.x[j] + shift}, axis) <= 0)
        found.insert({i, j});
    }
  return found;
}

TEST(Candidates, find_every_contact) {
  for (const double period : {0., .4}) {
    Scene s(1e8, .5);
    s.context.period = {period, 0, 0};
    random_blocks(s, 200, .4, 7);
    add_container(s.bodies, s.shapes, {0, 0, 0}, {.4, .4, .4}, .1, 0,
                  period > 0 ? kLowY | kHighY | kBase : kOpenTop);
    s.prepare();
    const Contacts found = touching_pairs(s);
    EXPECT_GT(found.size(), 200u);
    EXPECT_EQ(found, all_pairs(s)) << "period " << period;
    for (int p = 1; p < s.pairs.size(); ++p)
      EXPECT_LT(std::pair(s.pairs.a[p - 1], s.pairs.b[p - 1]),
                std::pair(s.pairs.a[p], s.pairs.b[p]));
  }
}

TEST(Candidates, miss_no_contact_while_bodies_fly) {
  Scene s(1e5, 0);
  s.context.gravity.setZero();
  random_blocks(s, 80, .5, 3);
  add_container(s.bodies, s.shapes, {0, 0, 0}, {.5, .5, .5}, .1, 0, kOpenTop | kLid);
  std::mt19937 random(1);
  for (int i = 0; i < s.bodies.grains; ++i) {
    const auto u = [&] { return random() / 2147483648. - 1; };
    s.bodies.v[i] = {u(), u(), u()};
    set_spin(s.bodies, i, 20 * Vec3(u(), u(), u()));
  }
  s.context.dt = 2e-4;
  s.prepare();
  int checked = 0;
  for (int k = 0; k < 1000; ++k) {
    s.step();
    if (k % 10 == 0) {
      const Contacts found = touching_pairs(s), all = all_pairs(s);
      ASSERT_EQ(found, all) << "step " << k;
      checked += all.size();
    }
  }
  EXPECT_GT(checked, 100);
  EXPECT_GT(s.candidates.state().rebuilds, 3);
  EXPECT_LT(s.candidates.state().rebuilds, 500);
}

TEST(Candidates, carry_history_of_pairs_that_stay) {
  Scene s(1e8, .5);
  random_blocks(s, 60, .2, 5);
  s.prepare();
  for (int p = 0; p < s.pairs.size(); ++p) s.pairs.friction[p] = Vec3(p, 2 * p, 1);
  const Pairs before = s.pairs;
  s.candidates.rebuild(s.bodies, s.shapes, s.context, s.pairs);
  ASSERT_EQ(s.pairs.size(), before.size());
  int moved = 0;
  for (int p = 0; p < before.size(); ++p) {
    int q = 0;
    while (q < before.size() && !(before.key(p) == s.pairs.key(q))) ++q;
    ASSERT_LT(q, before.size());
    EXPECT_EQ(s.pairs.friction[q], before.friction[p]);
    EXPECT_EQ(s.pairs.wake[q], before.wake[p]);
    moved += p != q;
  }
  EXPECT_GT(moved, 0);
}

// Spheres in a heap that goes on moving: after each search, of every kind first those that touch.
TEST(Candidates, put_touching_pairs_first) {
  Scene s(1e6, .5);
  for (int i = 0; i < 125; ++i)
    s.add(sphere_shape(.02), 2600,
          Vec3(.021 + .042 * (i % 5), .021 + .042 * (i / 5 % 5), .021 + .04 * (i / 25)));
  add_container(s.bodies, s.shapes, {0, 0, 0}, {.21, .21, .4}, .1, 0);
  s.context.dt = 1e-5;
  s.prepare();
  const long first = s.candidates.state().rebuilds;
  long searches = first;
  int touching = 0, near = 0;
  for (int k = 0; k < 4000; ++k) {
    const Contacts before = touching_pairs(s);
    s.step();
    if (s.candidates.state().rebuilds == searches) continue;
    searches = s.candidates.state().rebuilds;
    const auto before_this = [&](int p) { return before.count({s.pairs.a[p], s.pairs.b[p]}) > 0; };
    for (int p = 1; p < s.pairs.size(); ++p) {
      if (s.pairs.kind[p] != s.pairs.kind[p - 1]) continue;
      EXPECT_GE(before_this(p - 1), before_this(p));
      if (before_this(p - 1) == before_this(p)) {
        EXPECT_LT(s.pairs.key(p - 1), s.pairs.key(p));
      }
      (before_this(p) ? touching : near) += 1;
    }
  }
  EXPECT_GT(searches, first + 2);
  EXPECT_GT(touching, 200);
  EXPECT_GT(near, 200);
}

// What a contact loses as it opens is counted in that step, once.
TEST(Candidates, count_once_what_a_contact_loses_as_it_opens) {
  Scene s(1e6, .5);
  s.context.gravity.setZero();
  s.add(sphere_shape(.02), 2600, {0, 0, 0});
  s.add(sphere_shape(.02), 2600, {0, 0, .0401});
  s.bodies.v[1] = Vec3(.5, 0, -1);
  s.context.dt = 1e-6;
  s.prepare();
  while (!s.pairs.touching[0]) s.step();
  double held = 0;
  while (s.pairs.touching[0]) held = s.pairs.friction_energy[0], s.step();
  EXPECT_GT(held, 0);
  EXPECT_EQ(s.pairs.friction_loss[0], held);
  const double lost = s.flow.friction;
  for (int k = 0; k < 100; ++k) s.step();
  EXPECT_EQ(s.pairs.friction_loss[0], 0);
  EXPECT_EQ(s.flow.friction, lost);
  EXPECT_GT(s.pairs.wake[0], s.candidates.travel()[0] + s.candidates.travel()[1]);
}

TEST(Candidates, refuse_a_periodic_box_of_less_than_three_grains) {
  Scene s(1e8, 0);
  s.context.period = {.1, 0, 0};
  s.add_block({.05, .05, .05}, 1000, {0, 0, 0});
  s.context.dt = 1e-5;
  EXPECT_THROW(s.prepare(), InputError);
}

// The same four blocks inside the box, and across the seam; positions wrapped or not.
TEST(PeriodicSeam, is_as_inside) {
  std::vector<Vec3> way[3];
  for (int variant = 0; variant < 3; ++variant) {
    Scene s(1e8, .5);
    s.context.period = {.5, .5, 0};
    s.context.gravity.setZero();
    const double shift = variant == 0 ? 0 : .25;
    const auto place = [&](double x, double y, double z) {
      Vec3 p(x + shift, y + shift, z);
      if (variant == 2)
        for (int d = 0; d < 2; ++d) p[d] -= .5 * std::floor(p[d] / .5);
      return p;
    };
    const Vec3 e(.06, .05, .04);
    s.add_block(e, 1000, place(.22, .25, 0), turn_about({1, 2, 0}, .4));
    s.add_block(e, 1000, place(.27, .25, 0), turn_about({0, 2, 1}, .8));
    s.add_block(e, 1000, place(.25, .29, 0), turn_about({1, 0, 1}, 1.2));
    s.add_block(e, 1000, place(.25, .23, .04), turn_about({1, 1, 1}, .2));
    std::vector<Vec3> x0 = s.bodies.x;
    s.context.dt = 2e-6;
    s.prepare();
    EXPECT_GE(count_contacts(s.pairs), 3);
    for (int k = 0; k < 500; ++k) s.step();
    for (int i = 0; i < 4; ++i) way[variant].push_back(s.bodies.x[i] - x0[i]);
  }
  for (int i = 0; i < 4; ++i) {
    EXPECT_GT(way[0][i].norm(), 1e-6);
    EXPECT_LT((way[1][i] - way[0][i]).norm(), 1e-8 * way[0][i].norm());
    EXPECT_LT((way[2][i] - way[0][i]).norm(), 1e-8 * way[0][i].norm());
  }
}

}  // namespace
}  // namespace trackbed::dem
