// Friction of one contact: kinematics, Coulomb's cap, energy.
#include <gtest/gtest.h>

#include "dem/contact/friction.h"
#include "dem/motion/rotation.h"
#include "motion_scene.h"

namespace trackbed::dem {
namespace {

PairMaterial material() {
  PairMaterial m;
  m.modulus = 1e8, m.friction = .5, m.tangential_ratio = .25;
  return m;
}

TEST(Friction, stiffness_is_the_ratio_of_the_normal_one_face_on_face) {
  const double A = .04, k_n = 4 * 1e8 / (3 * std::sqrt(M_PI)) * std::sqrt(A);
  EXPECT_NEAR(tangential_stiffness(material(), A), .25 * k_n, 1e-12 * k_n);
}

TEST(Friction, rigid_motion_of_a_pair_is_no_slip) {
  const Vec3 turn(.3, -.2, .5), xa(.1, .2, .3), xb(-.4, .1, 0), c(.05, .2, .1);
  const Quat q = from_rotation_vector(turn);
  const Vec3 shift(.01, .02, -.03);
  const auto moved = [&](const Vec3& p) -> Vec3 { return q * p + shift; };
  const double dt = .1;
  const ContactSlip s =
      contact_slip<Vec3>(dt, (moved(xa) - xa) / dt, turn, c - xa, moved(c) - moved(xa),
                         (moved(xb) - xb) / dt, turn, c - xb, moved(c) - moved(xb));
  EXPECT_LT(s.displacement.norm(), 1e-15);
  EXPECT_LT((turned(xa, turn) - q * xa).norm(), 1e-15);
}

// Series and closed forms meet.
TEST(Friction, turn_helpers_are_continuous) {
  for (const double t : {.0199, .0201, .0316, .0317}) {
    const Vec3 turn = t * Vec3(1, 2, -2) / 3, v(1, -1, .5);
    EXPECT_LT((turned(v, turn) - Eigen::AngleAxisd(t, turn / t) * v).norm(), 1e-15);
    EXPECT_NEAR(secant_turn(turn).norm(), 2 * std::tan(t / 2), 1e-16);
  }
}

TEST(Friction, sticks_then_slips_and_books_every_joule) {
  const PairMaterial m = material();
  const double area = .01, N = 100, k = tangential_stiffness(m, area), du = 1e-7;
  Vec3 force = Vec3::Zero(), old = force;
  double stiffness = k, work = 0, lost = 0, stored = 0;
  const auto move = [&](double d) {
    old = force;
    const FrictionResult r =
        advance_friction(m, {0, 0, 1}, N, area, {{d, 0, 0}, Vec3::Zero()}, force, stiffness);
    work -= (old + force).x() / 2 * d;
    lost += r.dissipated, stored = r.stored;
  };
  for (int i = 0; i < 1000; ++i) move(du);
  EXPECT_NEAR(force.x(), -std::min(.5 * N, 1000 * du * k), 1e-9);
  EXPECT_DOUBLE_EQ(force.x(), -50);
  EXPECT_NEAR(work, lost + stored, 1e-9 * work);
  for (int i = 0; i < 3000; ++i) move(-du);
  EXPECT_DOUBLE_EQ(force.x(), 50);
  // Reversals inside one step cost O(du).
  EXPECT_NEAR(work, lost + stored, 1e-4 * work);
  EXPECT_GT(lost, 0);
}

// Growing, then shrinking contact under steady slip below the cap: never gains energy, the books
// close with second order in the step.
double books(int steps, double& least_loss) {
  PairMaterial m = material();
  m.friction = 1e9;
  Vec3 force = Vec3::Zero();
  double stiffness = tangential_stiffness(m, 1e-4), work = 0, lost = 0, stored = 0;
  least_loss = 0;
  for (int i = 1; i <= steps; ++i) {
    const double t = double(i) / steps, area = 1e-4 + .01 * t * (1.2 - t);
    const Vec3 old = force;
    const double d = 1e-5 / steps;
    const FrictionResult r =
        advance_friction(m, {0, 0, 1}, 1, area, {{d, 0, 0}, Vec3::Zero()}, force, stiffness);
    work -= (old + force).x() / 2 * d;
    lost += r.dissipated, stored = r.stored;
    least_loss = std::min(least_loss, r.dissipated);
  }
  return std::abs(work - lost - stored) / work;
}

TEST(Friction, changing_contact_area_never_makes_energy) {
  double least = 0;
  const double e1 = books(200, least), e2 = books(400, least);
  EXPECT_GE(least, -1e-18);
  EXPECT_LT(e2, 1e-4);
  EXPECT_NEAR(std::log2(e1 / e2), 2, .3);
}

// A pair pressed and sheared, then both bodies turned a full circle about a slanted axis as one
// rigid body: the friction force turns along.
TEST(Friction, of_a_stuck_pair_turned_by_360_degrees) {
  for (const int steps : {36, 3600}) {
    Scene s(1e8, 5);
    s.context.gravity.setZero();
    const double a = .1;
    s.add_block({a, a, a}, 1000, {0, 0, 0});
    s.add_block({a, a, a}, 1000, {.01, .02, a - 1e-4}, turn_about({0, 0, 1}, .3));
    s.prepare();
    Bodies& b = s.bodies;
    s.context.dt = 1;
    // Shear by 1e-4, then the circle.
    b.v[0] = {1e-4, 0, 0};
    b.x[0] += b.v[0];
    s.evaluate(1);
    ASSERT_EQ(count_contacts(s.pairs), 1);
    const Vec3 friction = s.pairs.friction[0], force = s.pairs.force[0];
    ASSERT_GT(friction.norm(), 10);
    const Vec3 turn = 2 * M_PI / steps * Vec3(1, 2, 3).normalized();
    const Quat q = from_rotation_vector(turn);
    for (int k = 0; k < steps; ++k) {
      for (int i = 0; i < 2; ++i) {
        b.v[i] = q * b.x[i] - b.x[i];
        b.x[i] = q * b.x[i];
        b.q[i] = (q * b.q[i]).normalized();
        b.R[i] = b.q[i].toRotationMatrix();
        b.turn[i] = turn;
      }
      s.candidates.update(b, s.shapes, s.context, s.pairs);
      s.evaluate(1);
      if (k == steps / 2 - 1) {
        const Vec3 half = turned<Vec3>(friction, M_PI * Vec3(1, 2, 3).normalized());
        EXPECT_LT((s.pairs.friction[0] - half).norm(), 1e-10 * friction.norm()) << steps;
      }
    }
    EXPECT_LT((s.pairs.friction[0] - friction).norm(), 1e-10 * friction.norm()) << steps;
    EXPECT_LT((s.pairs.force[0] - force).norm(), 1e-9 * force.norm()) << steps;
    EXPECT_LT(s.pairs.friction_loss[0], 1e-10 * s.pairs.friction_energy[0]) << steps;
  }
}

}  // namespace
}  // namespace trackbed::dem
