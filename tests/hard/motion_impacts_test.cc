// Impacts that break codes: grazing, overlapping start, other units of length. No damping.
#include <gtest/gtest.h>

#include "motion_scene.h"

namespace trackbed::dem {
namespace {

Scene falling_block(double scale, double mu, const Vec3& v, const std::string& law,
                    double share = .05) {
  Scene s(1e8, mu, law);
  s.context.gravity.setZero();
  const Vec3 edges = scale * Vec3(.1, .07, .05);
  s.add_block(edges, 2600, scale * Vec3(0, 0, .0675), turn_about({1, 2, .5}, .9));
  s.add_floor(scale * 2, scale * .5);
  s.bodies.v[0] = v;
  s.prepare();
  s.context.dt = share * expected_limit(s.bodies, s.shapes, s.materials, {1, 1}).dt;
  return s;
}

TEST(Impact, grazing_at_any_angle_gains_no_energy) {
  int touched = 0;
  double most = 0;
  for (const double mu : {0., .3, 1., 2.})
    for (const double degrees : {0., 15., 30., 45., 60., 75., 85., 89.}) {
      const double a = degrees * M_PI / 180;
      Scene s = falling_block(1, mu, 2 * Vec3(std::sin(a), 0, -std::cos(a)), "stored_energy");
      const double before = s.now().total();
      bool touch = false;
      const double until = std::min(1., .02 / (2 * std::cos(a)));
      while (s.time < until) {
        s.step();
        touch |= count_contacts(s.pairs) > 0;
      }
      touched += touch;
      most = std::max(most, s.now().total() / before - 1);
      EXPECT_LT(s.now().kinetic, before * (1 + 1e-4)) << "mu " << mu << ", " << degrees;
    }
  EXPECT_EQ(touched, 32);
  RecordProperty("largest_gain", std::to_string(most));
}

// Two blocks start inside each other: they leave with what was stored, no faster.
TEST(Impact, overlapping_start_gives_back_what_is_stored) {
  for (const double depth : {.001, .01, .03}) {
    Scene s(1e8, .5);
    s.context.gravity.setZero();
    s.add_block({.1, .1, .1}, 2600, {0, 0, 0});
    s.add_block({.1, .1, .1}, 2600, {.01, .005, .1 - depth}, turn_about({1, 1, 3}, .3));
    s.prepare();
    s.context.dt = .05 * expected_limit(s.bodies, s.shapes, s.materials, {1, 1}).dt;
    const double stored = s.start.normal;
    ASSERT_GT(stored, 0);
    for (int k = 0; k < 20000 && count_contacts(s.pairs) > 0; ++k) s.step();
    EXPECT_EQ(count_contacts(s.pairs), 0) << depth;
    EXPECT_LT(s.now().kinetic, stored * (1 + 1e-3)) << depth;
    EXPECT_NEAR(s.closure(), 0, 1e-3 * stored) << depth;
  }
}

// Lengths by any factor, times by the same: the same dimensionless motion.
TEST(Impact, same_in_any_unit_of_length) {
  std::vector<Vec3> place, spin;
  for (const double scale : {1., 1e-9, 1e-3, 1e6}) {
    Scene s = falling_block(scale, .5, {.5, 0, -2}, "stored_energy");
    bool touch = false;
    for (int k = 0; k < 4000; ++k) s.step(), touch |= count_contacts(s.pairs) > 0;
    EXPECT_TRUE(touch);
    place.push_back(s.bodies.x[0] / scale);
    spin.push_back(s.bodies.omega[0] * scale);
  }
  for (std::size_t k = 1; k < place.size(); ++k) {
    EXPECT_LT((place[k] - place[0]).norm(), 1e-10 * place[0].norm());
    EXPECT_LT((spin[k] - spin[0]).norm(), 1e-10 * spin[0].norm());
  }
}

// Every law runs the same scenes; the one without a stored energy says so.
TEST(Impact, laws_by_name) {
  for (const std::string& law : pair_law_names()) {
    Scene s = falling_block(1, .5, {.5, 0, -2}, law);
    bool touch = false;
    while (s.time < .02) s.step(), touch |= count_contacts(s.pairs) > 0;
    EXPECT_TRUE(touch) << law;
    EXPECT_TRUE(s.bodies.v[0].allFinite()) << law;
    EXPECT_GT(s.bodies.v[0].z(), -2) << law;
    if (s.forces.stores_energy) {
      EXPECT_LT(std::abs(s.closure()), 1e-3 * s.start.kinetic) << law;
    }
    std::printf("%-16s energy from nowhere / kinetic energy before: %.2e\n", law.c_str(),
                s.closure() / s.start.kinetic);
  }
  EXPECT_THROW(make_pair_forces("stored enrgy", true), std::exception);
}

// Off costs nothing and equals the simpler model: friction left out against a coefficient of 0.
TEST(Effects, friction_off_is_bitwise_a_coefficient_of_zero) {
  Scene with = falling_block(1, .5, {.5, 0, -2}, "stored_energy");
  Scene without = falling_block(1, .5, {.5, 0, -2}, "stored_energy");
  PairMaterial m = with.materials(0, 0);
  m.friction = 0;
  with.materials.set(0, 0, m);
  without.forces = make_pair_forces("stored_energy", false);
  for (int k = 0; k < 3000; ++k) with.step(), without.step();
  EXPECT_EQ(with.bodies.x[0], without.bodies.x[0]);
  EXPECT_EQ(with.bodies.omega[0], without.bodies.omega[0]);
}

}  // namespace
}  // namespace trackbed::dem
