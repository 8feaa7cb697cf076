// Flat faces of dilated polyhedra (law hertz_flat) on deforming surfaces: force by area against the
// formula and against a rigid floor, forces as the energy's gradient, no bump at element edges,
// energy of a bounce, rest with friction.
#include <gtest/gtest.h>

#include "contact_support.h"
#include "dem/contact/restitution.h"
#include "dem/grain/parts.h"
#include "dem/surface/round_patch.h"
#include "motion_scene.h"
#include "surface_scene.h"

namespace trackbed::dem {
namespace {

using test::random_hull;
using test::rotation;

constexpr double kE = 1e8;

GrainShape dilated(const Polyhedron& core, double r) {
  return as_grain(make_dilated_shape({core, r}));
}

struct FlatScene : PatchScene {
  FlatScene(const Mesh& m, double friction = 0, const Vec3& period = Vec3::Zero())
      : PatchScene(m, .2, .5, kE, friction, "stored_energy", period) {
    law = make_round_patch_forces("hertz_flat", friction > 0);
    context.gravity.setZero();
  }
  int add_shape(const GrainShape& s, const Vec3& x, const Quat& q) {
    travel.push_back(0);
    return add_grain(bodies, shapes, shapes.add(s), 0, 1000, x, q);
  }
  const PartView& part() const { return shapes.flat_part(bodies.shape[0], 0); }
};

// The whole face of area A, by hand: Shao's Eq. 17 and Hertz of the deepest ball with its crown.
TEST(FlatOnSurface, face_is_by_area_on_however_many_facets) {
  const double r = .05, depth = 1e-4, area = .3 * .2;
  const GrainShape box = dilated(make_box({.3, .2, .4}), r);
  for (const int cells : {1, 5, 23})
    for (const double angle : {0., .4}) {
      FlatScene s(uneven_mesh(cells, cells));
      s.add_shape(box, {.03, -.07, .2 + r - depth}, turn_about({0, 0, 1}, angle) * box.turn);
      s.evaluate_afresh();
      const double crown = s.part().crown / 2 * (s.part().mean_square - .04);
      const double force = 4 / (3 * std::sqrt(M_PI)) * kE * std::sqrt(area) * depth +
                           4. / 3 * kE * std::sqrt(r) * std::pow(depth + crown, 1.5);
      EXPECT_NEAR(s.bodies.force[0].z(), force, 1e-9 * force) << cells;
      EXPECT_LT(s.bodies.force[0].head<2>().norm(), 1e-9 * force);
      EXPECT_LT(s.bodies.torque[0].norm(), 1e-9 * force);
      EXPECT_NEAR(s.nodal_sum().z(), -force, 1e-9 * force);
    }
}

// The same bodies on a level patch and on a thick rigid box, at any tilt.
TEST(FlatOnSurface, level_patch_is_a_rigid_floor) {
  Random random(3);
  int flats = 0;
  for (int k = 0; k < 30; ++k) {
    const GrainShape g =
        dilated(k % 2 ? make_box({.3, .2, .4}) : test::scaled(random_hull(random, 14), .25), .05);
    FlatScene s(uneven_mesh(7, 9));
    Scene t(kE, 0);
    t.round = make_round_forces("hertz_flat", false);
    t.context.gravity.setZero();
    s.add_shape(g, Vec3::Zero(), Quat::Identity());
    t.add(g, 1000, Vec3::Zero());
    t.add_floor(2, 1);
    // A face down, but for a tilt.
    const ConvexView& core = s.part().core;
    const int f = static_cast<int>(random.below(core.faces));
    static constexpr double tilts[] = {0, 1e-14, 1e-8, 1e-4, 1e-2, .1};
    const Vec3 tilt = tilts[k % 6] * random.direction();
    const Mat3 R = rotation(tilt) *
                   Quat::FromTwoVectors(Vec3(core.nx[f], core.ny[f], core.nz[f]), Vec3(0, 0, -1))
                       .toRotationMatrix();
    double low = 0;
    for (int v = 0; v < core.vertices; ++v)
      low = std::min(low, (R * Vec3(core.x[v], core.y[v], core.z[v])).z());
    const double depth = std::pow(10., random.uniform(-4, -2.3));
    const Vec3 x(random.uniform(-.3, .3), random.uniform(-.3, .3), .05 - low - depth);
    s.place(0, x, Quat(R).normalized()), t.bodies.x[0] = x, t.bodies.q[0] = Quat(R).normalized();
    t.bodies.R[0] = s.bodies.R[0];
    s.evaluate_afresh(), t.prepare();
    const Vec3 force = t.bodies.force[0], torque = t.bodies.torque[0];
    ASSERT_GT(force.z(), 0) << k;
    flats += t.pairs.area[0] > 1.5 * M_PI * .05 * t.pairs.depth[0];
    EXPECT_LT((s.bodies.force[0] - force).norm(), 1e-9 * force.norm()) << k;
    EXPECT_LT((s.bodies.torque[0] - torque).norm(), 1e-9 * force.norm()) << k;
    EXPECT_NEAR(s.energy(), t.now().normal, 1e-9 * t.now().normal) << k;
  }
  EXPECT_GT(flats, 15);
}

TEST(FlatOnSurface, forces_are_the_energys_gradient) {
  Random random(9);
  int flats = 0;
  for (int k = 0; k < 15; ++k) {
    static constexpr double unevenness[] = {1e-12, 1e-4, 2e-3};
    FlatScene s(wavy_mesh(4, unevenness[k % 3]));  // facets nearly parallel to a face
    const GrainShape g =
        dilated(k % 2 ? make_box({.3, .2, .4}) : test::scaled(random_hull(random, 12), .25), .05);
    s.add_shape(g, Vec3::Zero(), Quat::Identity());
    const ConvexView& core = s.part().core;
    const int f = static_cast<int>(random.below(core.faces));
    const Quat turn =
        turn_about(random.direction(), 1e-3 * (k % 4)) *
        Quat::FromTwoVectors(Vec3(core.nx[f], core.ny[f], core.nz[f]), Vec3(0, 0, -1));
    Vec3 x(random.uniform(-.5, .5), random.uniform(-.5, .5), .6);
    for (double depth = 0; depth < .004; x.z() -= 5e-4) {
      s.place(0, x, turn.normalized());
      s.evaluate_afresh();
      depth = s.contacts.size() ? s.contacts.depth[0] : 0;
    }
    const Mat3 R = s.bodies.R[0];
    x = s.bodies.x[0];
    ASSERT_EQ(count_contacts(s.contacts), 1);
    flats += s.contacts.area[0] > 1.5 * M_PI * .05 * s.contacts.depth[0];
    const std::vector<Vec3> on_node = s.patch.force;
    const Vec3 force = s.bodies.force[0], torque = s.bodies.torque[0];
    // All of it balances.
    Vec3 moment = torque + x.cross(force);
    for (int n = 0; n < s.patch.carried; ++n) moment += s.patch.node[n].cross(on_node[n]);
    EXPECT_LT((s.nodal_sum() + force).norm(), 1e-12 * force.norm());
    EXPECT_LT(moment.norm(), 1e-12 * force.norm());
    const double h = 1e-7;
    const auto energy = [&] {
      s.evaluate_afresh();
      return s.energy();
    };
    const auto moved = [&](const Vec3& step, const Vec3& spin) {
      s.bodies.x[0] = x + step, s.bodies.R[0] = rotation(spin) * R;
      const double u = energy();
      s.bodies.x[0] = x, s.bodies.R[0] = R;
      return u;
    };
    const Vec3 none = Vec3::Zero();
    for (int d = 0; d < 3; ++d) {
      const Vec3 e = h * Vec3::Unit(d);
      EXPECT_NEAR((moved(-e, none) - moved(e, none)) / (2 * h), force[d], 2e-5 * force.norm()) << k;
      EXPECT_NEAR((moved(none, -e) - moved(none, e)) / (2 * h), torque[d], 2e-5 * force.norm())
          << k;
    }
    for (int n = 0; n < s.patch.carried; ++n) {
      if (on_node[n].norm() < .1 * force.norm()) continue;
      for (const int d : {k % 3, 2}) {
        s.patch.node[n][d] -= h;
        const double down = energy();
        s.patch.node[n][d] += 2 * h;
        const double up = energy();
        s.patch.node[n][d] -= h;
        EXPECT_NEAR((down - up) / (2 * h), on_node[n][d], 2e-5 * force.norm()) << k << " " << n;
      }
    }
  }
  EXPECT_GT(flats, 10);
}

TEST(FlatOnSurface, slides_over_element_edges_without_a_bump) {
  FlatScene s(uneven_mesh(9, 7));
  const GrainShape box = dilated(make_box({.3, .2, .4}), .05);
  s.add_shape(box, {-.5, -.31, .25 - 1e-4}, turn_about({0, 0, 1}, .4) * box.turn);
  s.evaluate_afresh();
  const double weight = s.bodies.force[0].z();
  s.context.gravity = {0, 0, -weight / s.bodies.mass[0]};
  s.bodies.v[0] = {1, .7, 0};
  s.context.dt = 1e-4;
  double most = 0;
  for (int k = 0; k < 9000; ++k) {
    s.step();
    most = std::max(most, std::abs(s.bodies.v[0].z()));
  }
  EXPECT_GT(s.bodies.x[0].x(), .3);
  EXPECT_LT(most, 1e-10);
}

// A level plate so high that nothing but the bulge of its crown touches, by Hertz: the triangle under
// the bulge is found wherever the plate goes, by steps however short.
TEST(FlatOnSurface, bulge_alone_is_followed_over_the_mesh) {
  const double r = .05;
  FlatScene s(uneven_mesh(9, 9));
  const GrainShape plate = dilated(make_box({.4, .4, .1}), r);
  s.add_shape(plate, {-.6, -.5, 1}, plate.turn);
  const double bulge = s.part().crown / 2 * (s.part().mean_square - .0025), depth = bulge / 5;
  s.bodies.x[0].z() = .05 + r + bulge - depth;
  s.bodies.freedom[0] = kFixed;
  s.bodies.v[0] = {.5, .4, 0};
  s.context.dt = 5e-4;
  s.evaluate_afresh();
  const double force = 4. / 3 * kE * std::sqrt(r) * std::pow(depth, 1.5);
  for (int k = 0; k < 2000; ++k, s.step())
    ASSERT_NEAR(s.bodies.force[0].z(), force, 1e-6 * force) << s.bodies.x[0].transpose();
}

// Over a right-angled edge, half of the face over the void: half of the area answers.
TEST(FlatOnSurface, only_the_area_that_meets_counts) {
  const double r = .05, depth = 1e-4;
  const GrainShape box = dilated(make_box({.3, .2, .4}), r);
  FlatScene s(edge_mesh(3, 7, 1));
  s.add_shape(box, {0, .03, .2 + r - depth}, box.turn);
  s.evaluate_afresh();
  const double crown = s.part().crown / 2 * (s.part().mean_square - .04);
  const double force = 4 / (3 * std::sqrt(M_PI)) * kE * std::sqrt(.5 * .3 * .2) * depth +
                       4. / 3 * kE * std::sqrt(r) * std::pow(depth + crown, 1.5);
  EXPECT_NEAR(s.bodies.force[0].z(), force, 1e-6 * force);
}

// Elastic, without friction: a tilted box bounces; energy is kept, the better the smaller the step.
double open_energy(double dt) {
  FlatScene s(uneven_mesh(5, 5));
  const GrainShape box = dilated(make_box({.3, .2, .4}), .05);
  s.add_shape(box, {0, 0, .26}, turn_about({1, 2, 0}, 1e-3) * box.turn);
  s.bodies.v[0] = {0, 0, -.2};
  s.context.dt = dt;
  s.evaluate_afresh();
  const auto kinetic = [&] {
    const Vec3 spin = s.bodies.omega[0];
    const Vec3 own = s.bodies.R[0].transpose() * spin;
    return .5 * s.bodies.mass[0] * s.bodies.v[0].squaredNorm() +
           .5 * own.dot(s.bodies.inertia[0].cwiseProduct(own));
  };
  const double before = kinetic();
  double area = 0;
  for (double t = 0; t < .2; t += dt) {
    s.step();
    for (const double a : s.contacts.area) area = std::max(area, a);
  }
  EXPECT_GT(area, .02);  // it came down on its face
  EXPECT_EQ(count_contacts(s.contacts), 0);
  return std::abs(kinetic() / before - 1);
}

TEST(FlatOnSurface, a_bounce_keeps_its_energy) {
  const double coarse = open_energy(4e-5), fine = open_energy(1e-5);
  EXPECT_LT(fine, 1e-4);
  EXPECT_LT(fine, coarse / 8);
}

TEST(FlatOnSurface, falls_on_its_face_rests_and_is_carried_along) {
  FlatScene s(uneven_mesh(5, 5), .5);
  PairMaterial m = s.materials(0, 0);
  m.damping = damping_for_restitution("hertz_flat", .3);
  s.materials.set(0, 0, m);
  const GrainShape box = dilated(make_box({.3, .2, .4}), .05);
  s.add_shape(box, {0, 0, .27}, turn_about({1, 2, 0}, .05) * box.turn);
  s.context.gravity = {0, 0, -9.81};
  s.context.local_damping = .3;
  s.context.dt = 5e-5;
  s.evaluate_afresh();
  for (int k = 0; k < 30000; ++k) s.step();
  const double weight = 9.81 * s.bodies.mass[0];
  EXPECT_NEAR(s.bodies.force[0].z(), weight, 1e-6 * weight);
  EXPECT_LT(s.bodies.v[0].norm(), 1e-8);
  EXPECT_GT(s.contacts.area[0], .3 * .2);

  // The surface moves off smoothly and keeps a speed: the grain sticks to it.
  s.context.local_damping = 0;
  const Vec3 x = s.bodies.x[0], start = s.patch.node[0];
  const double begun = s.time;
  s.drive = [begun](PatchScene& p) {
    const double dt = p.context.dt, share = std::min(1., (p.time - begun) / .1),
                 speed = .025 * (1 - std::cos(M_PI * share));
    for (int n = 0; n < p.patch.carried; ++n) {
      p.patch.velocity[n] = Vec3(speed, 0, 0);
      p.patch.node[n] += dt * p.patch.velocity[n];
    }
    move_skirt(p.patch);
    p.contacts.node_travel += speed * dt;
  };
  for (int k = 0; k < 6000; ++k) s.step();
  EXPECT_NEAR(s.bodies.v[0].x(), .05, 2e-4);  // its rocking is not damped
  EXPECT_LT((s.bodies.x[0] - x - (s.patch.node[0] - start)).norm(), 1e-6);
}

}  // namespace
}  // namespace trackbed::dem
