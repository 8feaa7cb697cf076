// Contact of dilated polyhedra: the deepest balls against the conditions of the optimum, forces
// against finite differences of the energy, closed paths, limits that are known.
#include <gtest/gtest.h>

#include "contact_support.h"
#include "dem/contact/deepest_balls.h"
#include "dilated_pair.h"

namespace trackbed::dem {
namespace {

using test::place;
using test::random_hull;
using test::random_rotation;
using test::rotation;

constexpr double kE = 1e9;

GrainShape dilated(const Polyhedron& core, double r, double crown = .02) {
  return as_grain(make_dilated_shape({core, r}), crown);
}

Scene scene(double friction = 0) {
  Scene s(kE, friction);
  s.context.gravity.setZero();
  return s;
}

double energy_at(Scene& s) {
  s.prepare();
  return s.now().normal;
}

// Puts b so that the pair overlaps by about `depth`.
bool bring_together(Scene& s, Random& random, double depth) {
  const Vec3 way = random.direction();
  double near = 0, far = 4;
  for (int k = 0; k < 60; ++k) {
    const double middle = (near + far) / 2;
    place(s, 1, s.bodies.x[0] + middle * way, s.bodies.R[1]);
    s.prepare();
    const double d = s.pairs.size() && s.pairs.touching[0] ? s.pairs.depth[0] : 0;
    (d > depth ? near : far) = middle;
  }
  return count_contacts(s.pairs) == 1;
}

TEST(DeepestBalls, meet_the_conditions_of_the_optimum) {
  // A convex problem: x, y are optimal if and only if no corner lies downhill of them.
  Random random(5);
  int by_dimension[3][3] = {};
  for (int k = 0; k < 400; ++k) {
    ShapeTable table;
    const bool boxes = k % 3 == 0;
    const Polyhedron core = boxes ? make_box({1, .8, .6}) : random_hull(random, 14);
    const int a = table.add(dilated(core, .1)),
              b = table.add(dilated(random_hull(random, 12), .2, k % 2 ? .02 : .05));
    const PartView &u = table.part(a, 0), &v = table.part(b, 0);
    const Mat3 Ra = random_rotation(random), Rb = random_rotation(random);
    const Pose pose{Rb, random.uniform(2.2, 2.6) * random.direction()};
    Vec3 axis = Vec3::Zero();
    const DeepestBalls d = deepest_balls(u, Ra, v, pose, Vec3::Zero(), axis);
    const Vec3 x = Ra.transpose() * d.x, y = Rb.transpose() * (d.y - pose.x);
    // Slopes of |y-x| - r_a(x) - r_b(y) at x and at y, own frames.
    const Vec3 gx = -(Ra.transpose() * d.n) + u.crown * x, gy = Rb.transpose() * d.n + v.crown * y;
    for (int i = 0; i < u.core.vertices; ++i)
      EXPECT_GT(gx.dot(Vec3(u.core.x[i], u.core.y[i], u.core.z[i]) - x), -1e-9);
    for (int i = 0; i < v.core.vertices; ++i)
      EXPECT_GT(gy.dot(Vec3(v.core.x[i], v.core.y[i], v.core.z[i]) - y), -1e-9);
    const ClosestPoint fx = closest_point(u.core, x + 1e-6 * Ra.transpose() * d.n),
                       fy = closest_point(v.core, y - 1e-6 * Rb.transpose() * d.n);
    if (fx.dimension < 3 && fy.dimension < 3) ++by_dimension[fx.dimension][fy.dimension];
    // From another start the same.
    const DeepestBalls again = deepest_balls(u, Ra, v, pose, random.direction(), axis);
    EXPECT_NEAR(again.overlap, d.overlap, 1e-12);
    EXPECT_LT((again.n - d.n).norm(), 1e-9);
  }
  EXPECT_GT(by_dimension[0][2] + by_dimension[2][0], 20);
  EXPECT_GT(by_dimension[1][1], 20);
  EXPECT_GT(by_dimension[0][1] + by_dimension[1][0], 5);
}

TEST(DilatedContact, force_is_the_energys_gradient) {
  Random random(7);
  for (int k = 0; k < 40; ++k) {
    Scene s = scene();
    if (k % 2) s.round = make_round_forces("hertz_flat", false);
    s.add(dilated(random_hull(random, 14), .1), 1, Vec3::Zero());
    if (k % 3 == 0)
      s.add(make_grain_shape(random_hull(random, 10)), 1, Vec3::Zero());  // on a plain one
    else if (k % 3 == 1)
      s.add(dilated(make_box({1, .7, .9}), .25), 1, Vec3::Zero());  // unequal radii
    else
      s.add(sphere_shape(.3), 1, Vec3::Zero());
    place(s, 0, Vec3::Zero(), random_rotation(random));
    place(s, 1, Vec3::Zero(), random_rotation(random));
    ASSERT_TRUE(bring_together(s, random, .02));
    const Vec3 force = s.bodies.force[1], torque = s.bodies.torque[1], x = s.bodies.x[1];
    const Mat3 R = s.bodies.R[1];
    EXPECT_NEAR((s.bodies.force[0] + force).norm(), 0, 1e-12 * force.norm());
    const double h = 1e-6;
    for (int d = 0; d < 3; ++d) {
      place(s, 1, x + h * Vec3::Unit(d), R);
      const double up = energy_at(s);
      place(s, 1, x - h * Vec3::Unit(d), R);
      const double down = energy_at(s);
      EXPECT_NEAR((down - up) / (2 * h), force[d], 1e-6 * force.norm()) << k;
      place(s, 1, x, rotation(h * Vec3::Unit(d)) * R);
      const double left = energy_at(s);
      place(s, 1, x, rotation(-h * Vec3::Unit(d)) * R);
      const double right = energy_at(s);
      EXPECT_NEAR((right - left) / (2 * h), torque[d], 2e-6 * force.norm()) << k;
    }
  }
}

// Work along a closed path of a held box over a floor, through parallel faces, edges and corners.
TEST(DilatedContact, closed_path_takes_no_work) {
  Scene s = scene();
  s.add(dilated(make_box({1, .8, .6}), .1), 1, Vec3::Zero());
  s.add_floor(20, 1);
  const auto pose = [](double t, Vec3& x, Mat3& R) {
    const Vec3 turn(.3 * std::sin(t), .25 * std::sin(2 * t + 1), .2 * std::cos(t));
    R = rotation(turn);
    // The corner's height keeps near the floor.
    double low = 0;
    for (const Vec3& v : make_box({1, .8, .6}).vertices) low = std::min(low, (R * v).z());
    x = Vec3(.2 * std::cos(t), .1 * std::sin(t), .1 - .02 - .01 * std::cos(3 * t) - low);
  };
  const auto work = [&](int steps) {
    double sum = 0, most = 0;
    Vec3 x0, x1, f0, t0;
    Mat3 R0, R1;
    pose(0, x0, R0);
    place(s, 0, x0, R0);
    most = energy_at(s);
    f0 = s.bodies.force[0], t0 = s.bodies.torque[0];
    for (int k = 1; k <= steps; ++k) {
      pose(2 * M_PI * k / steps, x1, R1);
      place(s, 0, x1, R1);
      most = std::max(most, energy_at(s));
      const Eigen::AngleAxisd turn(R1 * R0.transpose());
      sum += (f0 + s.bodies.force[0]).dot(x1 - x0) / 2 +
             (t0 + s.bodies.torque[0]).dot(turn.angle() * turn.axis()) / 2;
      x0 = x1, R0 = R1, f0 = s.bodies.force[0], t0 = s.bodies.torque[0];
    }
    return std::abs(sum) / most;
  };
  const double coarse = work(500), fine = work(2000);
  EXPECT_LT(fine, 2e-4);
  EXPECT_LT(fine, coarse / 8 + 1e-10);  // the trapezoidal rule's own error, falls with h^2
}

TEST(DilatedContact, face_on_face_is_smooth_through_parallel) {
  // A crowned face of curvature c on a plane rolls: at tilt t the contact has moved by t/c, so that
  // the torque about the centre, h above the core's face, is F t (1/c - h).
  const double h = .3;
  Scene s = scene();
  s.add(dilated(make_box({1, .8, 2 * h}), .1), 1, Vec3::Zero());
  s.add_floor(20, 1);
  const PartView& part = s.shapes.part(s.bodies.shape[0], 0);
  const GrainShape& shape = s.shapes.shape(s.bodies.shape[0]);
  const Mat3 R0 = shape.turn.toRotationMatrix();
  double last = 0;
  for (const double tilt : {-1e-3, -1e-6, -1e-14, 0., 1e-14, 1e-6, 1e-3}) {
    place(s, 0, {0, 0, h + .1 - .001}, rotation({0, tilt, 0}) * R0);
    s.prepare();
    const double force = s.bodies.force[0].z(), torque = s.bodies.torque[0].y();
    EXPECT_GT(force, 0);
    EXPECT_NEAR(torque, -force * tilt * (1 / part.crown - h),
                1e-4 * std::abs(force * tilt / part.crown) + 1e-12 * force);
    if (last != 0) {
      EXPECT_NEAR(force, last, .06 * last);
    }
    last = force;
  }
}

TEST(DilatedContact, resultant_does_not_count_corners) {
  // Prisms of 3, 4, 6, 24 corners on a floor: Hertz's force of a ball of radius r on a plane at the
  // overlap of the face's middle.
  for (const int corners : {3, 4, 6, 24}) {
    std::vector<Vec3> points;
    for (int k = 0; k < corners; ++k)
      for (const double z : {-.5, .5})
        points.push_back({std::cos(2 * M_PI * k / corners), std::sin(2 * M_PI * k / corners), z});
    Scene s = scene();
    const GrainShape shape = dilated(convex_hull(points), .1);
    s.add(shape, 1, {0, 0, .599}, shape.turn);
    s.add_floor(20, 1);
    s.prepare();
    const PartView& part = s.shapes.part(s.bodies.shape[0], 0);
    const double r = .1 + part.crown / 2 * (part.mean_square - .25), delta = r - .099;
    ASSERT_GT(delta, 0);
    const double hertz = 4. / 3 * kE * std::sqrt(.1) * std::pow(delta, 1.5);
    EXPECT_NEAR(s.bodies.force[0].z(), hertz, 1e-9 * hertz) << corners;
  }
}

TEST(DilatedContact, a_core_that_shrinks_to_a_point_is_the_sphere) {
  // An oblique impact with friction, as a sphere and as a dilated tetrahedron of 1e-7 of its size.
  const auto run = [](bool sphere) {
    Scene s(kE, .3);
    s.context.gravity.setZero();
    Polyhedron core = convex_hull({{1, 1, 1}, {-1, -1, 1}, {-1, 1, -1}, {1, -1, -1}});
    for (Vec3& v : core.vertices) v *= 1e-9;
    s.add(sphere ? sphere_shape(.01) : dilated(core, .01), 2600, {0, 0, .0101});
    s.add_floor(1, .5);
    s.bodies.v[0] = {1, .5, -1};
    s.context.dt = 1e-6;
    s.prepare();
    for (int k = 0; k < 600; ++k) s.step();
    return std::pair(s.bodies.v[0], s.bodies.omega[0]);
  };
  const auto [v, omega] = run(true);
  const auto [vd, omegad] = run(false);
  EXPECT_GT(v.z(), .9);
  EXPECT_LT((v - vd).norm(), 1e-5);
  EXPECT_LT((omega - omegad).norm(), 1e-5 * omega.norm());
}

TEST(DilatedContact, keeps_its_sense_when_cores_overlap) {
  // Pushed into each other far beyond the radii, force grows and points outwards.
  Scene s = scene();
  s.add(dilated(make_box({1, 1, 1}), .05), 1, Vec3::Zero());
  s.add(dilated(make_box({1, 1, 1}), .1), 1, Vec3::Zero());
  double last = 0;
  for (const double gap : {.149, .1, .05, .01, 1e-4, -1e-4, -.01, -.05, -.2}) {
    place(s, 1, {.02, .01, 1 + gap}, Mat3::Identity());
    s.prepare();
    ASSERT_EQ(count_contacts(s.pairs), 1) << gap;
    EXPECT_GT(s.bodies.force[1].z(), last) << gap;
    last = s.bodies.force[1].z();
  }
  // A sphere's centre passes into a polyhedron: overlap goes on evenly.
  Scene t = scene();
  t.add(sphere_shape(.1), 1, Vec3::Zero());
  t.add_floor(2, 1);
  for (const double z : {.09, .05, 1e-9, -1e-9, -.05, -.2}) {
    place(t, 0, {.1, .1, z}, Mat3::Identity());
    t.prepare();
    EXPECT_NEAR(t.pairs.depth[0], .1 - z, 1e-12);
    EXPECT_GT(t.bodies.force[0].z(), 0);
  }
}

// Led together until cores meet and apart again, in any pose: the overlap changes with the way, step
// by step, but for a hundredth of the radius where another way out is the nearest, and what is left
// at the end is as if nothing had been.
TEST(DilatedContact, goes_on_evenly_where_cores_come_to_meet) {
  Random random(9);
  const double r = .05, step = 2e-4;
  int laid = 0;
  for (int k = 0; k < 200; ++k) {
    Scene s = scene();
    s.add(dilated(k % 2 ? make_box({1, .8, .6}) : random_hull(random, 12), r), 1, Vec3::Zero());
    s.add(make_grain_shape(make_box({.9, .7, 1})), 1, Vec3::Zero());
    for (int i : {0, 1}) place(s, i, Vec3::Zero(), random_rotation(random));
    if (!bring_together(s, random, .6 * r)) continue;
    ++laid;
    const Vec3 start = s.bodies.x[1];
    s.pairs = Pairs();
    s.prepare();
    const Vec3 way = -s.bodies.force[1].normalized();
    const Vec3 force = s.bodies.force[1], torque = s.bodies.torque[1];
    double last = s.pairs.depth[0], most = 0;
    for (int n = 1; n <= 220; ++n) {
      place(s, 1, start + (n <= 110 ? n : 220 - n) * step * way, s.bodies.R[1]);
      s.prepare();
      ASSERT_TRUE(s.bodies.force[1].allFinite()) << k << ", step " << n;
      ASSERT_LT(std::abs(s.pairs.depth[0] - last), step + .01 * r) << k << ", step " << n;
      last = s.pairs.depth[0], most = std::max(most, last);
    }
    EXPECT_GT(most, r) << k;
    EXPECT_LT((s.bodies.force[1] - force).norm(), 1e-7 * force.norm()) << k;
    EXPECT_LT((s.bodies.torque[1] - torque).norm(), 1e-7 * force.norm()) << k;
  }
  EXPECT_GT(laid, 150);
}

TEST(SphereOnPolyhedron, edges_and_corners_are_no_holes) {
  // Around a cube at constant distance from it the force has one size, whatever the feature.
  Scene s = scene();
  s.add(sphere_shape(.2), 1, Vec3::Zero());
  s.add_block({1, 1, 1}, 1, Vec3::Zero());
  Random random(3);
  const double force = 4. / 3 * kE * std::sqrt(.2) * std::pow(.01, 1.5);
  for (int k = 0; k < 300; ++k) {
    const Vec3 n = random.direction();
    Vec3 foot;  // a point of the cube with n in its normal cone: corner, edge or face by k
    for (int d = 0; d < 3; ++d) foot[d] = std::copysign(.5, n[d]);
    Vec3 m = n;
    if (k % 3 > 0) m.x() = 0, foot.x() = .3;
    if (k % 3 > 1) m.y() = 0, foot.y() = -.2;
    m.normalize();
    place(s, 0, foot + .19 * m, Mat3::Identity());
    s.prepare();
    EXPECT_LT((s.bodies.force[0] - force * m).norm(), 1e-9 * force) << k % 3;
  }
}

}  // namespace
}  // namespace trackbed::dem
