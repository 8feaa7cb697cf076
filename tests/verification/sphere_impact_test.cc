// Spheres against closed forms: Chung and Ooi 2011 (Granular Matter 13:643), tests 1-7. Expected
// values are theirs or Hertz's theory, not this code's.
#include "known/sphere_impact.h"

#include <gtest/gtest.h>

#include "base/error.h"

namespace trackbed::dem {
namespace {

struct HertzCase {
  double delta, force, time;
};

// Largest overlap, force, duration of tests 1 and 2 with n steps a contact.
HertzCase two_spheres(int steps) {
  const Elastic m{48e9, .2};
  Scene s = sphere_scene(m.modulus() / 2, m.ratio(), 0, 1);
  s.context.dt = kImpactTime / steps;
  s.add(sphere_shape(.01), 2800, {-.01 - 1e-12, 0, 0});
  s.add(sphere_shape(.01), 2800, {.01, 0, 0});
  s.bodies.v[0].x() = 10, s.bodies.v[1].x() = -10;
  const Impact r = collide(s);
  return {r.depth, r.force, r.time};
}

TEST(ChungOoi, test_1_two_spheres) {
  const HertzCase r = two_spheres(100);
  EXPECT_NEAR(r.delta, 2.741127e-4, 1e-3 * 2.741127e-4);
  EXPECT_NEAR(r.force, 1.069689e4, 1e-3 * 1.069689e4);
  EXPECT_NEAR(r.time, 4.033945e-5, 1e-3 * 4.033945e-5);
}

TEST(ChungOoi, test_1_is_second_order_in_time) {
  const ImpactErrors coarse = impact_errors(50), fine = impact_errors(200);
  EXPECT_LT(fine.rebound, 1e-5);
  EXPECT_NEAR(std::log(coarse.rebound / fine.rebound) / std::log(4.), 2.5, .2);
  EXPECT_NEAR(std::log(coarse.duration / fine.duration) / std::log(4.), 2, .2);
}

TEST(ChungOoi, test_2_sphere_on_rigid_plane) {
  const Elastic m{70e9, .3};
  Scene s = sphere_scene(m.modulus(), m.ratio(), 0, 1);
  s.context.dt = 7.316566e-4 / 100;
  s.add(sphere_shape(.1), 2699, {0, 0, .1 + 1e-12});
  s.add_floor(1, .5);
  s.bodies.v[0].z() = -.2;
  const Impact r = collide(s);
  EXPECT_NEAR(r.depth, 4.971718e-5, 1e-3 * 4.971718e-5);
  EXPECT_NEAR(r.force, 1.136986e4, 1e-3 * 1.136986e4);
  EXPECT_NEAR(r.time, 7.316566e-4, 1e-3 * 7.316566e-4);
}

class Restitution : public ::testing::TestWithParam<const char*> {};

TEST_P(Restitution, test_3_out_is_in_without_tension) {
  const std::string law = GetParam();
  for (const double e : {.2, .4, .6, .8, .9, .98}) {
    const Elastic m{380e9, .23};
    Scene s = sphere_scene(m.modulus(), m.ratio(), 0, e, law, 2e7);
    s.add(sphere_shape(.0025), 4000, {0, 0, .0025 + 1e-12});
    s.add_floor(.1, .05);
    s.bodies.v[0].z() = -3.9;
    const double t = law == "linear"
                         ? M_PI * std::sqrt(s.bodies.mass[0] / 2e7)
                         : 2.94328 *
                               std::pow(5 * s.bodies.mass[0] * 3.9 * 3.9 /
                                            (4 * 4. / 3 * m.modulus() * std::sqrt(.0025)),
                                        .4) /
                               3.9;
    s.context.dt = t / (law == "linear" ? 1500 : 300);  // a dashpot's force starts with a jump
    const Impact r = collide(s);
    EXPECT_NEAR(r.v.z() / 3.9, e, 1e-3) << law;
    const double lost = .5 * s.bodies.mass[0] * 3.9 * 3.9;
    EXPECT_NEAR(s.closure(), 0, 5e-3 * lost) << law << " e " << e;
  }
}

INSTANTIATE_TEST_SUITE_P(laws, Restitution, ::testing::Values("hertz_mindlin", "linear"));

TEST(RestitutionOfLaws, clipping_alone_would_turn_e_into_more) {
  const double given[] = {.2, .4, .6, .8}, clipped[] = {.3249, .4720, .6323, .8081};
  for (int k = 0; k < 4; ++k)
    EXPECT_NEAR(restitution(true, tsuji_damping(given[k])), clipped[k], 2e-4);
  // Linear, closed form (Schwager and Poeschel, Granular Matter 9 (2007) 465): b = alpha/2 < 1/sqrt
  // 2, e = exp(-b/w (pi - atan(2 b w/(w^2 - b^2)))), w^2 = 1 - b^2.
  for (const double b : {.1, .3, .6}) {
    const double w = std::sqrt(1 - b * b);
    EXPECT_NEAR(restitution(false, 2 * b),
                std::exp(-b / w * (M_PI - std::atan2(2 * b * w, w * w - b * b))), 1e-5);
  }
  for (const char* law : {"hertz_mindlin", "hertz_flat", "linear", "sun2015"})
    for (const double e : {.05, .5, .9, 1.})
      EXPECT_NEAR(restitution_for_damping(law, damping_for_restitution(law, e)), e, 1e-6) << law;
  EXPECT_THROW(damping_for_restitution("of_ones_own", .5), InputError);
  EXPECT_THROW(damping_for_restitution("linear", 0), InputError);
  EXPECT_THROW(damping_for_restitution("linear", 1.1), InputError);
}

// A sphere hits a plane at an angle from the normal; without friction's work on rotation at first.
Impact oblique(double degrees, double mu, double e, int steps) {
  const Elastic m{380e9, .23};
  Scene s = sphere_scene(m.modulus(), m.ratio(), mu, e);
  const double r = .0025, a = degrees * M_PI / 180;
  s.add(sphere_shape(r), 4000, {0, 0, r + 1e-12});
  s.add_floor(.1, .05);
  s.bodies.v[0] = {3.9 * std::sin(a), 0, -3.9 * std::cos(a)};
  const double v = 3.9 * std::cos(a);
  s.context.dt =
      2.94328 / v / steps *
      std::pow(5 * s.bodies.mass[0] * v * v / (4 * 4. / 3 * m.modulus() * std::sqrt(r)), .4);
  return collide(s);
}

TEST(ChungOoi, test_4_oblique_sliding) {
  const double mu = .092, e = .98, r = .0025;
  for (const double degrees : {30., 45., 60., 75., 85.}) {
    const double a = degrees * M_PI / 180;
    const Impact out = oblique(degrees, mu, e, 200);
    const double e_t = 1 - mu * (1 + e) / std::tan(a),
                 spin = 2.5 * mu * (1 + e) * 3.9 * std::cos(a) / r;
    EXPECT_NEAR(out.v.x() / (3.9 * std::sin(a)), e_t, 5e-3 * e_t) << degrees;
    EXPECT_NEAR(out.omega.y(), spin, 5e-3 * spin) << degrees;
  }
  const Impact at_45 = oblique(45, mu, e, 200);
  EXPECT_NEAR(at_45.v.x() / (3.9 * std::sqrt(.5)), .817840, 5e-3);
  EXPECT_NEAR(at_45.omega.y(), 502.346, .005 * 502.346);
}

TEST(ChungOoi, test_4_steep_impacts_stick) {
  // Below the angle of sliding the rebound spin reverses the contact point's motion: the recoil of
  // the tangential spring. Energy out is less than in at every angle.
  for (const double degrees : {0., 2., 5., 10., 20.}) {
    const Impact out = oblique(degrees, .092, .98, 200);
    const double energy = out.v.squaredNorm() + .4 * .0025 * .0025 * out.omega.squaredNorm();
    EXPECT_LE(energy, 3.9 * 3.9 * (1 + 1e-4)) << degrees;
  }
}

TEST(ChungOoi, test_5_oblique_impacts_follow_maw) {
  // Test 5 (r 10 mm, 5 m/s, mu .5, steel-like): gross sliding ends at tan = mu (7 - 1/k)...; in the
  // sliding range rebound follows v_t' = v_t - mu (1+e) v_n, checked where psi1 is large.
  const double mu = .5, e = 1;
  for (const double degrees : {80., 85.}) {
    const double a = degrees * M_PI / 180;
    const Impact out = oblique(degrees, mu, e, 200);
    EXPECT_NEAR(out.v.x(), 3.9 * std::sin(a) - mu * 2 * 3.9 * std::cos(a), 5e-3 * 3.9);
  }
}

TEST(ChungOoi, test_6_spin_only) {
  const double r = .1, v = .2, mu = .4, e = .5;
  const Elastic m{70e9, .33};
  for (const double surface : {1., 1.5, 2.}) {  // r omega [m/s], all of it sliding
    Scene s = sphere_scene(m.modulus(), m.ratio(), mu, e);
    s.add(sphere_shape(r), 2700, {0, 0, r + 1e-12});
    s.add_floor(1, .5);
    s.bodies.v[0].z() = -v;
    set_spin(s.bodies, 0, {0, surface / r, 0});
    s.context.dt = 7.3e-4 / 200;
    const Impact out = collide(s);
    // Tangential restitution of the contact point: v_t' = beta v_t with the sense of -1 + ...
    const double beta = -1 + 3.5 * mu * (1 + e) * v / surface;
    const double point = out.v.x() - r * out.omega.y();
    EXPECT_NEAR(point / surface, beta, .01) << surface;
    EXPECT_NEAR(out.v.x(), mu * (1 + e) * v, .01 * mu * (1 + e) * v) << surface;
  }
}

TEST(ChungOoi, test_7_opposite_spins_stay) {
  const Elastic m{70e9, .33};
  Scene s = sphere_scene(m.modulus() / 2, m.ratio(), .4, .5);
  s.add(sphere_shape(.1), 2700, {-.1 - 1e-12, 0, 0});
  s.add(sphere_shape(.1), 2700, {.1, 0, 0});
  s.bodies.v[0].x() = .2, s.bodies.v[1].x() = -.2;
  set_spin(s.bodies, 0, {0, 0, 3});
  set_spin(s.bodies, 1, {0, 0, -3});
  s.context.dt = 7.3e-4 / 200;
  const Impact out = collide(s);
  EXPECT_NEAR(out.v.y(), 0, 1e-10);
  EXPECT_NEAR(out.omega.z(), 3, 1e-10);
}

Scene on_plane(double mu, double tilt, double modulus = 1e7) {
  Scene s = sphere_scene(modulus, .8, mu, 1);
  s.context.gravity = {9.81 * std::sin(tilt), 0, -9.81 * std::cos(tilt)};
  s.add(sphere_shape(.05), 2600, Vec3::Zero());
  // Where its weight is carried.
  const double weight = s.bodies.mass[0] * 9.81 * std::cos(tilt);
  const double depth = std::pow(weight / (4. / 3 * modulus * std::sqrt(.05)), 2. / 3);
  s.bodies.x[0].z() = .05 - depth;
  s.add_floor(50, 1);
  s.context.dt = 2e-5;
  s.prepare();
  return s;
}

TEST(RollingSphere, slips_then_rolls) {
  const double mu = .3, v0 = 1;
  Scene s = on_plane(mu, 0);
  s.bodies.v[0].x() = v0;
  const double t = 2 * v0 / (7 * mu * 9.81);
  s.run(.98 * t);
  EXPECT_GT(s.bodies.v[0].x() - .05 * s.bodies.omega[0].y(), 0);
  s.run(1.1 * t);
  // The tangential spring, undamped, still swings: means over many of its periods.
  double v = 0, spin = 0;
  const int steps = 5000;
  for (int k = 0; k < steps; ++k) {
    s.step();
    v += s.bodies.v[0].x() / steps, spin += s.bodies.omega[0].y() / steps;
  }
  EXPECT_NEAR(v, 5. / 7 * v0, 2e-3);
  EXPECT_NEAR(v, .05 * spin, 2e-3);
}

TEST(RollingSphere, down_an_incline) {
  const double tilt = 20 * M_PI / 180;
  Scene s = on_plane(.5, tilt);
  s.run(.5);
  EXPECT_NEAR(s.bodies.v[0].x() / .5, 5. / 7 * 9.81 * std::sin(tilt), 2e-3 * 9.81);
}

TEST(BouncingSphere, stops_when_the_series_ends) {
  // h = 1 m, e = .5: sqrt(2h/g) (1+e)/(1-e) = 1.354571 s, for contacts much shorter than flights.
  const double r = .01;
  Scene s = sphere_scene(5e8, .8, 0, .5);
  s.context.gravity = {0, 0, -9.81};
  s.add(sphere_shape(r), 2600, {0, 0, 1 + r});
  s.add_floor(1, .5);
  s.context.dt = 1e-6;
  s.prepare();
  double last = 0;  // it was above 0.1 mm
  for (long k = 0; k < 1500000; ++k) {
    s.step();
    if (s.bodies.x[0].z() > r + 1e-4) last = s.time;
  }
  // Bounces below a height h_n end after another 2 sqrt(2 h_n/g)/(1-e) at most.
  EXPECT_NEAR(last, 1.354571, 2 * std::sqrt(2 * 1e-4 / 9.81) / .5 + 2e-3);
  EXPECT_LT(std::abs(s.bodies.v[0].z()), 1e-3);
}

}  // namespace
}  // namespace trackbed::dem
