// Bodies that are not convex, made of convex polyhedra: forces and moments are the sum over the
// parts, and a body cut in parts moves as the body does.
#include <gtest/gtest.h>

#include "dem/contact/friction.h"
#include "dem/grain/random.h"
#include "motion_scene.h"

namespace trackbed::dem {
namespace {

constexpr double kModulus = 1e9;

Polyhedron box(const Vec3& low, const Vec3& high) {
  Polyhedron p = make_box(high - low);
  Vec3 least = p.vertices[0];
  for (const Vec3& v : p.vertices) least = least.cwiseMin(v);
  for (Vec3& v : p.vertices) v += low - least;
  return p;
}

// Two boxes side by side, as high as 0.1 m: 0.2 x 0.1 m and 0.1 x 0.1 m.
std::vector<Polyhedron> ell_parts() {
  return {box({0, 0, 0}, {.2, .1, .1}), box({0, .1, 0}, {.1, .2, .1})};
}

// A grain of the parts' own frame at x, turned by q.
int place(Scene& s, const GrainShape& shape, const Vec3& x, const Quat& q = Quat::Identity()) {
  return s.add(shape, 2600, x + q * shape.origin, q * shape.turn);
}

TEST(Union, ell_has_the_mass_of_its_boxes) {
  const GrainShape ell = union_shape(ell_parts());
  EXPECT_NEAR(ell.volume, .003, 1e-15);
  // (2 (.1, .05) + (.05, .15))/3 in plan.
  EXPECT_LT((ell.origin - Vec3(.25 / 3, .25 / 3, .05)).norm(), 1e-15);
  // About the vertical: V (a^2 + b^2)/12 + V r^2 of both boxes.
  const auto one = [&](double v, double a, double b, double x, double y) {
    return v * ((a * a + b * b) / 12 + (Vec3(x, y, .05) - ell.origin).squaredNorm());
  };
  const double about_z = one(.002, .2, .1, .1, .05) + one(.001, .1, .1, .05, .15);
  EXPECT_NEAR(ell.inertia.maxCoeff(), about_z, 1e-15);
}

// Pressed into a floor by d, each box is a contact of its own, Shao 2017 Eq. 17 face on face:
// F = 4E/(3 sqrt(pi)) sqrt(A) d at the middle of its base.
TEST(Union, ell_on_a_plane) {
  const double d = 1e-7;
  for (const double turn : {0., .3, 2.}) {
    Scene s(kModulus, 0);
    s.context.gravity.setZero();
    const Quat q = turn_about({0, 0, 1}, turn);
    const int body = place(s, union_shape(ell_parts()), Vec3(.1, -.2, -d), q);
    s.add_floor(1, .2);
    s.prepare();
    ASSERT_EQ(count_contacts(s.pairs), 2);
    const auto force = [&](double area) { return kShaoFactor * kModulus * std::sqrt(area) * d; };
    const double f1 = force(.02), f2 = force(.01);
    const Vec3 centre = s.bodies.x[body];
    const Vec3 arm1 = Vec3(.1, -.2, -d) + q * Vec3(.1, .05, 0) - centre;
    const Vec3 arm2 = Vec3(.1, -.2, -d) + q * Vec3(.05, .15, 0) - centre;
    const Vec3 up(0, 0, 1), moment = arm1.cross(f1 * up) + arm2.cross(f2 * up);
    EXPECT_LT((s.bodies.force[body] - (f1 + f2) * up).norm(), 1e-8 * f1);
    EXPECT_LT((s.bodies.torque[body] - moment).norm(), 1e-8 * f1 * .1);
  }
}

// Against the convex parts as bodies of their own, at the same places.
TEST(Union, two_unions_are_the_sum_over_their_parts) {
  Random random(31);
  int contacts = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const GrainShape ell = union_shape(ell_parts());
    const Quat qa = turn_about(random.direction(), 3), qb = turn_about(random.direction(), 2);
    const Vec3 xa = Vec3::Zero(), xb = random.uniform(.12, .2) * random.direction();
    Scene whole(kModulus, 0), apart(kModulus, 0);
    // Centres at xa, xb.
    whole.add(ell, 2600, xa, qa), whole.add(ell, 2600, xb, qb);
    whole.prepare();
    std::vector<int> owner;
    for (const int side : {0, 1})
      for (const ConvexPart& part : ell.parts) {
        const Quat& q = side ? qb : qa;
        const GrainShape own = make_grain_shape(part.core);
        apart.add(own, 2600, (side ? xb : xa) + q * own.origin, q * own.turn);
        owner.push_back(side);
      }
    apart.prepare();
    Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
    double scale = 0;
    int expected = 0;
    for (int p = 0; p < apart.pairs.size(); ++p) {
      if (!apart.pairs.touching[p]) continue;
      const int i = apart.pairs.a[p], j = apart.pairs.b[p];
      if (owner[i] == owner[j]) continue;
      ++expected;
      const double sign = owner[i] == 0 ? 1 : -1;
      const Vec3 f = sign * apart.pairs.force[p];
      force += f;
      torque +=
          (apart.bodies.x[i] + apart.pairs.arm_a[p] - xa).cross(f) + sign * apart.pairs.couple[p];
      scale += f.norm();
    }
    ASSERT_EQ(count_contacts(whole.pairs), expected);
    contacts += expected;
    EXPECT_LE((whole.bodies.force[0] - force).norm(), 1e-9 * scale);
    EXPECT_LE((whole.bodies.force[1] + force).norm(), 1e-9 * scale);
    EXPECT_LE((whole.bodies.torque[0] - torque).norm(), 1e-9 * scale * .1);
  }
  EXPECT_GT(contacts, 60);
}

// A cube and the same cube of two halves fall on a floor, turning, from the same place.
struct Fall {
  Scene s;
  Fall(bool halves, double tilt, double turn) : s(1e10, 0) {
    s.context.gravity.setZero();
    const std::vector<Polyhedron> parts{box({-.05, -.05, -.05}, {0, .05, .05}),
                                        box({0, -.05, -.05}, {.05, .05, .05})};
    const GrainShape shape =
        halves ? union_shape(parts) : make_grain_shape(make_box(Vec3::Constant(.1)));
    // An edge along x, which both halves share, or (turn) a corner comes first.
    const Quat q =
        turn_about({0, 0, 1}, turn) * turn_about({1, 0, 0}, tilt) * turn_about({0, 1, 0}, turn);
    double low = HUGE_VAL;
    for (const Vec3& v : make_box(Vec3::Constant(.1)).vertices) low = std::min(low, (q * v).z());
    // Shapes have their own principal frames.
    s.add(shape, 2600, {0, 0, -low + 1e-9}, q * shape.turn);
    s.add_floor(1, .2);
    s.bodies.v[0].z() = -.05;
    s.context.dt = 1e-8;
    s.prepare();
  }
  void rebound() {
    bool touched = false;
    for (int k = 0; k < 400000; ++k) {
      s.step();
      const bool touching = count_contacts(s.pairs) > 0;
      if (touched && !touching) break;
      touched = touched || touching;
    }
  }
  Mat3 place() const {  // of the cube's own axes, whatever the principal frame
    return s.bodies.R[0] * s.shapes.shape(s.bodies.shape[0]).turn.conjugate().toRotationMatrix();
  }
};

TEST(Union, cube_of_two_halves_falls_and_turns_as_the_cube) {
  Fall cube(false, .4, .2), halves(true, .4, .2);
  for (Fall* f : {&cube, &halves}) {
    f->s.context.dt = 1e-4, f->s.context.gravity = {0, 0, -9.81};
    f->s.bodies.x[0].z() = 5;
    set_spin(f->s.bodies, 0, {3, -7, 2});
    f->s.run(.5);
  }
  EXPECT_LT((cube.s.bodies.x[0] - halves.s.bodies.x[0]).norm(), 1e-12);
  EXPECT_LT((cube.place() - halves.place()).norm(), 1e-11);
}

// Rigid frictionless impulse: on an edge at 15 degrees v'/v = 1/7, omega a/v = 2.4244; flat v' = v.
// An edge that both halves share is two contacts, stiffer by up to 1.4, and the same impulse.
TEST(Union, cube_of_two_halves_rebounds_as_the_cube) {
  for (const bool halves : {false, true}) {
    Fall edge(halves, M_PI / 12, 0);
    edge.rebound();
    EXPECT_NEAR(edge.s.bodies.v[0].z() / .05, .142857, .01) << halves;
    EXPECT_NEAR(edge.s.bodies.omega[0].norm() * .1 / .05, 2.424366, .0243) << halves;
    Fall flat(halves, 0, 0);
    flat.rebound();
    EXPECT_NEAR(flat.s.bodies.v[0].z() / .05, 1, .01) << halves;
    EXPECT_LT(flat.s.bodies.omega[0].norm() * .1 / .05, 1e-6) << halves;
  }
  // A corner belongs to one half alone: the same contact, the same motion.
  Fall cube(false, .6, .5), two(true, .6, .5);
  cube.rebound(), two.rebound();
  EXPECT_LT((cube.s.bodies.v[0] - two.s.bodies.v[0]).norm(), 1e-6 * .05);
  EXPECT_LT((cube.s.bodies.omega[0] - two.s.bodies.omega[0]).norm(), 1e-6);
}

}  // namespace
}  // namespace trackbed::dem
