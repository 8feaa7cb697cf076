// Dilated polyhedra with flat faces: force by area against the formula, by hand; overlaps of the
// flat parts against an area cut by hand and against all faces; force and torque as the energy's
// gradient from flat to tilted; rest.
#include "dem/contact/flat_contact.h"

#include <gtest/gtest.h>

#include "contact_support.h"
#include "dem/contact/face_prism.h"
#include "dem/contact/flat_cap.h"
#include "dilated_pair.h"

namespace trackbed::dem {
namespace {

using test::random_hull;
using test::random_rotation;
using test::rotation;

constexpr double kE = 1e9;

GrainShape dilated(const Polyhedron& core, double r) {
  return as_grain(make_dilated_shape({core, r}));
}

Scene scene(double friction = 0) {
  Scene s(kE, friction);
  s.round = make_round_forces("hertz_flat", friction > 0);
  s.context.gravity.setZero();
  return s;
}

void place(Scene& s, int i, const Vec3& x, const Mat3& R) {
  test::place(s, i, x, R);
  s.prepare();
}

Polyhedron prism(int corners, double area, double height) {
  const double r = std::sqrt(2 * area / (corners * std::sin(2 * M_PI / corners)));
  std::vector<Vec3> points;
  for (int k = 0; k < corners; ++k)
    for (const double z : {-.5, .5})
      points.push_back(
          {r * std::cos(2 * M_PI * k / corners), r * std::sin(2 * M_PI * k / corners), z * height});
  return convex_hull(points);
}

// Shao's Eq. 17 face on face and Hertz's force of the deepest ball, its crown included.
double force_by_hand(const PartView& part, double face, double area, double depth) {
  const double crown = part.crown / 2 * (part.mean_square - face * face);
  return 4 / (3 * std::sqrt(M_PI)) * kE * std::sqrt(area) * depth +
         4. / 3 * kE * std::sqrt(part.radius) * std::pow(depth + crown, 1.5);
}

TEST(FlatContact, face_on_face_is_by_area) {
  for (const int corners : {3, 4, 6, 24, 40})
    for (const double area : {.5, 2.})
      for (const double depth : {1e-4, 1e-3}) {
        Scene s = scene();
        const GrainShape shape = dilated(prism(corners, area, 1), .1);
        s.add(shape, 1, Vec3::Zero(), shape.turn);
        s.add_floor(20, 1);
        place(s, 0, {0, 0, .6 - depth}, shape.turn.toRotationMatrix());
        const double force =
            force_by_hand(s.shapes.flat_part(s.bodies.shape[0], 0), .5, area, depth);
        EXPECT_NEAR(s.bodies.force[0].z(), force, 1e-9 * force) << corners;
        EXPECT_LT(s.bodies.torque[0].norm(), 1e-9 * force) << corners;
      }
}

TEST(FlatContact, only_the_area_that_meets_counts) {
  // A box half over the floor's border, and two boxes that lie crosswise.
  const double depth = 1e-4;
  Scene s = scene();
  const GrainShape box = dilated(make_box({1, .8, .6}), .1);
  s.add(box, 1, Vec3::Zero());
  s.add_floor(2, 1);
  place(s, 0, {2, 0, .4 - depth}, box.turn.toRotationMatrix());
  const PartView& part = s.shapes.flat_part(s.bodies.shape[0], 0);
  const double half = force_by_hand(part, .3, .4, depth);
  EXPECT_NEAR(s.bodies.force[0].z(), half, 1e-4 * half);
  EXPECT_NEAR(s.bodies.torque[0].y(), .25 * half, 2e-2 * half);  // the ball lies elsewhere

  Scene t = scene();
  t.add(box, 1, Vec3::Zero());
  t.add(box, 1, Vec3::Zero());
  place(t, 0, Vec3::Zero(), box.turn.toRotationMatrix());
  place(t, 1, {0, 0, .8 - depth}, rotation({0, 0, M_PI / 2}) * box.turn.toRotationMatrix());
  const double crown = part.crown * (part.mean_square - .09);  // of both
  const double force = 4 / (3 * std::sqrt(M_PI)) * kE * .8 * depth +
                       4. / 3 * kE * std::sqrt(.05) * std::pow(depth + crown, 1.5);
  EXPECT_NEAR(t.bodies.force[1].z(), force, 1e-9 * force);
}

// Area and centroid of what of a convex polygon (x, z) lies below z = 0, by cutting and shoelace.
double cut_area(const std::vector<Vec2>& p, Vec2& centroid) {
  std::vector<Vec2> below;
  for (std::size_t k = 0; k < p.size(); ++k) {
    const Vec2 &a = p[k], &b = p[(k + 1) % p.size()];
    if (a.y() <= 0) below.push_back(a);
    if ((a.y() <= 0) != (b.y() <= 0)) below.push_back(a + a.y() / (a.y() - b.y()) * (b - a));
  }
  double area = 0;
  centroid.setZero();
  for (std::size_t k = 0; k < below.size(); ++k) {
    const Vec2 &a = below[k], &b = below[(k + 1) % below.size()];
    const double w = (a.x() * b.y() - a.y() * b.x()) / 2;
    area += w, centroid += w * (a + b) / 3;
  }
  centroid /= area;
  return area;
}

TEST(FlatContact, overlap_of_a_tilted_prism_is_that_cut_by_hand) {
  const double r = .1, h = .3, width = .8;
  ShapeTable table;
  const GrainShape box = dilated(make_box({1, width, 2 * h}), r);
  table.add(box);
  table.add(make_grain_shape(make_box({40, 40, 40})));
  int overlapping = 0;
  for (const double tilt : {0., 1e-14, 1e-6, 1e-4, 1e-3, 1e-2, .03, .06, .2})
    for (const double sink : {1e-5, 1e-4, 1e-3}) {
      const Mat3 turn = rotation({0, tilt, 0}), R = turn * box.turn.toRotationMatrix();
      // Deepest ball by `sink` below z = 0; positive tilt lowers the end at +x.
      const Vec3 low = turn * Vec3(tilt > 0 ? .5 : 0, 0, -h);
      const Vec3 place(0, 0, r - sink - low.z());
      std::vector<Vec2> polygon;
      for (const Vec3& p :
           {Vec3(-.5, 0, -h), Vec3(-.5, 0, -h - r), Vec3(.5, 0, -h - r), Vec3(.5, 0, -h)}) {
        const Vec3 at = place + turn * p;
        polygon.push_back({at.x(), at.z()});
      }
      Vec2 centroid;
      const double area = cut_area(polygon, centroid);
      Vec3 axis(0, 0, -1);
      const Pose floor{Mat3::Identity(), Vec3(0, 0, -20) - place};
      const DeepestBalls balls =
          deepest_balls(table.flat_part(0, 0), R, table.flat_part(1, 0), floor, Vec3::Zero(), axis);
      NormalContact c;
      OverlapWorkspace work;
      const bool touches = flat_contact(table.flat_part(0, 0), R, table.flat_part(1, 0), floor,
                                        balls, test::material(kE), work, c);
      ASSERT_EQ(touches, area > 0) << tilt << " " << sink;
      if (!touches) continue;
      ++overlapping;
      EXPECT_NEAR(c.shape.volume, width * std::abs(area), 1e-7 * std::abs(width * area)) << tilt;
      EXPECT_NEAR(c.centroid.x(), centroid.x(), 1e-6);
      EXPECT_NEAR(c.centroid.z() + place.z(), centroid.y(), 1e-9);
    }
  EXPECT_GT(overlapping, 15);
}

// Puts b so that the deepest balls overlap by `depth`, a face of b on one of a but for a tilt.
void face_on_face(Scene& s, Random& random, double tilt, double depth) {
  const ConvexView &u = s.shapes.flat_part(s.bodies.shape[0], 0).core,
                   &v = s.shapes.flat_part(s.bodies.shape[1], 0).core;
  const int f = static_cast<int>(random.below(u.faces)),
            g = static_cast<int>(random.below(v.faces));
  const Mat3 Ra = random_rotation(random);
  const Vec3 n = Ra * Vec3(u.nx[f], u.ny[f], u.nz[f]);
  const Quat turn = Quat::FromTwoVectors(Vec3(v.nx[g], v.ny[g], v.nz[g]), -n).normalized();
  const Mat3 Rb = rotation(tilt * random.direction()) * turn.toRotationMatrix();
  const Vec3 aside = .2 * random.direction();
  const Vec3 across = aside - n.dot(aside) * n;
  place(s, 0, Vec3::Zero(), Ra);
  double near = 0, far = 4;
  for (int k = 0; k < 60; ++k) {
    const double middle = (near + far) / 2;
    place(s, 1, middle * n + across, Rb);
    const double d = s.pairs.size() && s.pairs.touching[0] ? s.pairs.depth[0] : 0;
    (d > depth ? near : far) = middle;
  }
  place(s, 1, near * n + across, Rb);
}

TEST(FlatContact, no_face_is_left_out) {
  // Against the overlaps of all faces' prisms of both.
  Random random(12);
  int flats = 0;
  for (int k = 0; k < 60; ++k) {
    Scene s = scene();
    const double ra = random.uniform(.05, .2), rb = random.uniform(.05, .2);
    s.add(dilated(k % 2 ? make_box({1, .8, .6}) : random_hull(random, 14), ra), 1, Vec3::Zero());
    s.add(dilated(random_hull(random, 20), rb), 1, Vec3::Zero());
    const PartView &a = s.shapes.flat_part(s.bodies.shape[0], 0),
                   &b = s.shapes.flat_part(s.bodies.shape[1], 0);
    for (int n = 0; n < 10; ++n) {
      face_on_face(s, random, random.uniform(0, .6), std::pow(10., random.uniform(-4, -1.3)));
      const Pose own{s.bodies.R[0], Vec3::Zero()}, pose{s.bodies.R[1], s.bodies.x[1]};
      Vec3 axis = s.bodies.x[1];
      const DeepestBalls balls = deepest_balls(a, own.R, b, pose, Vec3::Zero(), axis);
      OverlapWorkspace work;
      NormalContact c;
      const bool found = flat_contact(a, own.R, b, pose, balls, test::material(kE), work, c);
      double volume = 0;
      FacePrism p, q;
      for (int f = 0; f < a.core.faces; ++f)
        for (int g = 0; g < b.core.faces; ++g) {
          make_face_prism(a.core, f, 0, ra, p), make_face_prism(b.core, g, 0, rb, q);
          OverlapMoments m;
          work.clear();
          const ContactFrame frame = contact_frame(p.view, own, q.view, pose, balls.n);
          if (overlap(p.view, own, q.view, pose, frame, work, m)) volume += m.volume;
        }
      flats += found;
      EXPECT_NEAR(found ? c.shape.volume : 0, volume, 1e-9 * volume + 1e-15);
    }
  }
  EXPECT_GT(flats, 200);
}

TEST(FlatContact, cap_in_a_face_is_the_overlap_of_both_prisms) {
  // In closed form, against clipping; and where it says that nothing overlaps, nothing does.
  Random random(5);
  int found = 0, nothing = 0;
  for (int k = 0; k < 200; ++k) {
    Scene s = scene();
    const double r = random.uniform(.05, .2);
    s.add(dilated(k % 3 ? random_hull(random, 14) : make_box({1, .8, .6}), r), 1, Vec3::Zero());
    if (k % 4)
      s.add(dilated(random_hull(random, 10), r), 1, Vec3::Zero());
    else
      s.add(make_grain_shape(random_hull(random, 10)), 1, Vec3::Zero());
    face_on_face(s, random, random.uniform(0, .2), std::pow(10., random.uniform(-3, -1.5)));
    const PartView &a = s.shapes.flat_part(s.bodies.shape[0], 0),
                   &b = s.shapes.flat_part(s.bodies.shape[1], 0);
    const Pose own{s.bodies.R[0], Vec3::Zero()}, pose{s.bodies.R[1], s.bodies.x[1]};
    for (int f = 0; f < a.core.faces; ++f)
      for (int g = 0; g < b.core.faces; ++g) {
        SimpleContact c;
        const FlatOverlap is = flat_cap(a.core, own.R, {f, r}, b.core, pose, {g, b.radius}, c);
        if (is == FlatOverlap::unsure) continue;
        FacePrism p, q;
        make_face_prism(a.core, f, 0, r, p);
        if (b.radius > 0) make_face_prism(b.core, g, 0, r, q);
        const ConvexView& v = b.radius > 0 ? q.view : b.core;
        OverlapMoments m;
        OverlapWorkspace work;
        const ContactFrame frame = contact_frame(p.view, own, v, pose, s.bodies.x[1]);
        const bool overlaps = overlap(p.view, own, v, pose, frame, work, m);
        if (is == FlatOverlap::nothing) {
          // Of a plain body only what lies below its face was looked at.
          ++nothing;
          EXPECT_LT(m.volume, 1e-15);
          continue;
        }
        ++found;
        ASSERT_TRUE(overlaps) << k;
        const OverlapShape expected = make_shape(m, work);
        EXPECT_NEAR(c.shape.volume, expected.volume, 1e-9 * expected.volume) << k;
        const Vec3 centroid = frame.origin + frame.axes * expected.centroid;
        EXPECT_LT((c.frame.origin + c.frame.axes * c.shape.centroid - centroid).norm(), 1e-9);
        const Vec3 area = frame.axes * expected.area;
        EXPECT_LT((c.frame.axes * c.shape.area - area).norm(), 1e-8 * area.norm()) << k;
        const Mat3 C = frame.axes * expected.second_moment * frame.axes.transpose();
        EXPECT_LT((c.frame.axes * c.shape.second_moment * c.frame.axes.transpose() - C).norm(),
                  1e-8 * C.norm());
      }
  }
  EXPECT_GT(found, 50);
  EXPECT_GT(nothing, 100);
}

TEST(FlatContact, force_is_the_energys_gradient_from_flat_to_tilted) {
  Random random(7);
  int flats = 0;
  for (int k = 0; k < 40; ++k) {
    Scene s = scene();
    s.add(dilated(k % 2 ? make_box({1, .8, .6}) : random_hull(random, 12), .1), 1, Vec3::Zero());
    if (k % 3 == 0)
      s.add(make_grain_shape(random_hull(random, 10)), 1, Vec3::Zero());  // on a plain one
    else
      s.add(dilated(random_hull(random, 14), .2), 1, Vec3::Zero());
    static constexpr double tilts[5] = {0, 1e-14, 1e-6, 1e-3, 1e-1};
    face_on_face(s, random, tilts[k % 5], .01);
    const Vec3 force = s.bodies.force[1], torque = s.bodies.torque[1], x = s.bodies.x[1];
    const Mat3 R = s.bodies.R[1];
    ASSERT_EQ(count_contacts(s.pairs), 1);
    flats += s.pairs.area[0] > 1.01 * M_PI * .1 * s.pairs.depth[0];
    EXPECT_LT((s.bodies.force[0] + force).norm(), 1e-12 * force.norm());
    const Vec3 about = s.bodies.torque[0] + torque + x.cross(force);
    EXPECT_LT(about.norm(), 1e-12 * force.norm());
    const double h = 1e-7;
    const auto energy = [&](const Vec3& at, const Mat3& turn) {
      place(s, 1, at, turn);
      return s.now().normal;
    };
    for (int d = 0; d < 3; ++d) {
      const Vec3 e = h * Vec3::Unit(d);
      EXPECT_NEAR((energy(x - e, R) - energy(x + e, R)) / (2 * h), force[d], 1e-5 * force.norm())
          << k;
      EXPECT_NEAR((energy(x, rotation(-e) * R) - energy(x, rotation(e) * R)) / (2 * h), torque[d],
                  1e-5 * force.norm())
          << k;
    }
  }
  EXPECT_GT(flats, 25);
}

TEST(FlatContact, is_continuous_through_parallel) {
  Scene s = scene();
  const GrainShape box = dilated(make_box({1, .8, .6}), .1);
  s.add(box, 1, Vec3::Zero());
  s.add_floor(20, 1);
  const Mat3 R0 = box.turn.toRotationMatrix();
  const auto at = [&](double tilt) {
    place(s, 0, {0, 0, .3 + .1 - .001}, rotation({.3 * tilt, tilt, 0}) * R0);
    return std::pair(s.bodies.force[0], s.bodies.torque[0]);
  };
  const auto [force, torque] = at(0);
  EXPECT_LT(torque.norm(), 1e-12 * force.norm());
  for (const double tilt : {1e-14, 1e-12, 1e-9, 1e-6, 1e-4, 1e-3})
    for (const double sign : {-1., 1.}) {
      const auto [f, t] = at(sign * tilt);
      // A Winkler bed as wide as 1 and 1 mm deep: the torque is 3 of its tilt stiffness.
      EXPECT_LT((f - force).norm(), (1e-11 + 100 * tilt) * force.norm()) << tilt;
      EXPECT_LT(t.norm(), (1e-11 + 1e3 * tilt) * force.norm()) << tilt;
      if (tilt > 1e-9) {
        EXPECT_LT(sign * t.y(), 0);  // it rights itself
      }
    }
}

TEST(FlatContact, falls_on_its_face_and_rests) {
  // With friction and damping: what is missing of the energy is in the ledger, the more so the
  // smaller the step; and nothing rattles.
  const auto fall = [](double share) {
    Scene s(1e8, .5);
    s.round = make_round_forces("hertz_flat", true);
    PairMaterial m = s.materials(0, 0);
    m.damping = damping_for_restitution("hertz_flat", .3);
    s.materials.set(0, 0, m);
    const GrainShape box = dilated(make_box({.04, .03, .02}), .004);
    s.add(box, 2600, {0, 0, .019}, turn_about({1, 2, 0}, .1) * box.turn);
    s.add_floor(1, .5);
    s.prepare();
    s.context.dt = share * expected_limit(s.bodies, s.shapes, s.materials, {}).dt;
    s.run(.1);
    return s;
  };
  Scene s = fall(.05);
  const double weight = 9.81 * s.bodies.mass[0], fallen = .005;
  EXPECT_LT(std::abs(s.closure()), 2e-3 * weight * fallen);
  EXPECT_LT(std::abs(fall(.0125).closure()), std::abs(s.closure()) / 8);
  s.context.local_damping = .5;
  s.run(.3);
  EXPECT_LT(s.bodies.v[0].norm(), 1e-9);
  const Vec3 spin = s.bodies.omega[0];  // on its point of friction it may go on, like a top
  EXPECT_LT(std::hypot(spin.x(), spin.y()), 1e-9);
  EXPECT_NEAR(s.bodies.force[0].z(), weight, 1e-6 * weight);
  const Vec3 up = s.bodies.q[0] * (s.shapes.shape(0).turn.conjugate() * Vec3(0, 0, 1));
  EXPECT_NEAR(up.z(), 1, 1e-9);
}

}  // namespace
}  // namespace trackbed::dem
