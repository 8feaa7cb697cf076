// Grains on a deforming surface: the same force as on a rigid box, equal and opposite on the nodes.
#include <gtest/gtest.h>

#include "base/error.h"
#include "dem/contact/friction.h"
#include "dem/grain/random.h"
#include "dem/grain/voronoi.h"
#include "dem/surface/penetration.h"
#include "motion_scene.h"
#include "surface_scene.h"

namespace trackbed::dem {
namespace {

constexpr double kModulus = 1e7;

Quat random_turn(Random& random) {
  return Quat(Eigen::AngleAxisd(random.uniform(0, 2 * M_PI), random.direction()));
}

/// A Voronoi grain of about unit size.
const Polyhedron& grain(int seed) {
  static const std::vector<Polyhedron> grains = [] {
    VoronoiParameters v;
    v.count = 20, v.seed = 11;
    return voronoi_grains(v);
  }();
  return grains[seed % 20];
}

/// Puts grain i so that its lowest point lies `depth` below the plane through the origin.
void sink(PatchScene& s, int i, const Vec3& up, const Vec3& at, const Quat& q, double depth) {
  const ConvexView v = s.shapes.view(s.bodies.shape[i]);
  s.place(i, Vec3::Zero(), q);
  double low = HUGE_VAL;
  for (int k = 0; k < v.vertices; ++k)
    low = std::min(low, up.dot(s.bodies.R[i] * Vec3(v.x[k], v.y[k], v.z[k])));
  s.bodies.x[i] = at - (low + depth) * up;
}

struct Answer {
  Vec3 force, torque;
};

Answer on_rigid_box(const Polyhedron& body, const Vec3& x, const Quat& q, const Quat& tilt,
                    const std::string& law) {
  Scene s(kModulus, 0, law);
  const GrainShape g = make_grain_shape(body);
  add_grain(s.bodies, s.shapes, s.shapes.add(g), 0, 1000, x, q);
  s.add_floor(4, 2, tilt);
  s.prepare();
  return {s.bodies.force[0], s.bodies.torque[0]};
}

void expect_near(const Vec3& a, const Vec3& b, double tolerance, const char* what) {
  EXPECT_LE((a - b).norm(), tolerance) << what << ": " << a.transpose() << " | " << b.transpose();
}

class Laws : public testing::TestWithParam<const char*> {};

TEST_P(Laws, flat_cube_feels_a_rigid_box) {
  for (const int n : {3, 16, 40})
    for (const double mesh_angle : {0., .3}) {
      Mesh mesh = flat_mesh(n, n, -2, 2, -2, 2);
      turn_mesh(mesh, turn_about({0, 0, 1}, mesh_angle));
      // On an edge, on a node, inside, anywhere.
      for (const Vec3& at : {Vec3(0, .01, 0), Vec3(0, 0, 0), Vec3(.5, .5, 0), Vec3(.13, -.21, 0)}) {
        PatchScene s(mesh, .1, .2, kModulus, 0, GetParam());
        s.add(make_box({1, 1, 1}), 1000, at + Vec3(0, 0, .5 - .02));
        s.evaluate_afresh();
        const Answer box = on_rigid_box(make_box({1, 1, 1}), s.bodies.x[0], s.bodies.q[0],
                                        Quat::Identity(), GetParam());
        const double size = box.force.norm();
        ASSERT_NEAR(size, 4 * kModulus * .02 / (3 * std::sqrt(M_PI)), 1e-5 * size);
        expect_near(s.bodies.force[0], box.force, 1e-12 * size, "force");
        expect_near(s.bodies.torque[0], box.torque, 1e-12 * size, "torque");
      }
    }
}

TEST_P(Laws, random_grain_feels_a_rigid_box) {
  Random random(5);
  for (int k = 0; k < 40; ++k) {
    const Quat tilt = k % 2 ? random_turn(random) : Quat::Identity();
    const Vec3 up = tilt * Vec3(0, 0, 1);
    Mesh mesh = flat_mesh(k % 3 ? 9 : 30, 11, -2, 2, -2, 2);
    turn_mesh(mesh, tilt * turn_about({0, 0, 1}, random.uniform(0, 1)));
    PatchScene s(mesh, .1, .2, kModulus, 0, GetParam());
    s.add(grain(k), 1000, Vec3::Zero());
    const Vec3 at = tilt * Vec3(random.uniform(-.5, .5), random.uniform(-.5, .5), 0);
    sink(s, 0, up, at, random_turn(random), random.uniform(1e-4, .05));
    s.evaluate_afresh();
    const Answer box = on_rigid_box(grain(k), s.bodies.x[0], s.bodies.q[0], tilt, GetParam());
    const double size = box.force.norm();
    ASSERT_GT(size, 0);
    expect_near(s.bodies.force[0], box.force, 1e-9 * size, "force");
    expect_near(s.bodies.torque[0], box.torque, 1e-9 * size, "torque");
  }
}

INSTANTIATE_TEST_SUITE_P(Both, Laws, testing::Values("stored_energy", "shao2017"));

// A grain let down below a plane stands in it by that much, however long its overlap is said to be.
TEST(Penetration, is_how_far_the_grain_was_let_down) {
  Random random(6);
  for (int k = 0; k < 20; ++k) {
    const Quat tilt = random_turn(random);
    const Vec3 up = tilt * Vec3(0, 0, 1);
    Mesh mesh = flat_mesh(11, 11, -2, 2, -2, 2);
    turn_mesh(mesh, tilt);
    PatchScene s(mesh, .4, .2, kModulus);
    s.add(grain(k), 1000, Vec3::Zero());
    const double depth = random.uniform(1e-4, .2);
    sink(s, 0, up, Vec3::Zero(), random_turn(random), depth);
    s.evaluate_afresh();
    ASSERT_EQ(s.contacts.touching[0], 1);
    EXPECT_NEAR(penetration(s.bodies, s.shapes, s.contacts, 0), depth, 1e-9);
    s.contacts.depth[0] = 10;
    EXPECT_NEAR(penetration(s.bodies, s.shapes, s.contacts, 0), depth, 1e-9);
    s.contacts.depth[0] = depth / 2;
    EXPECT_EQ(penetration(s.bodies, s.shapes, s.contacts, 0), depth / 2);
  }
}

TEST(Nodes, take_back_what_the_grains_get) {
  Random random(8);
  for (int k = 0; k < 30; ++k) {
    Mesh mesh = k % 2 ? edge_mesh(6, 12, 2) : flat_mesh(13, 9, -2, 2, -2, 2);
    for (Vec3& p : mesh.nodes) p += .01 * random.uniform() * random.direction();
    turn_mesh(mesh, random_turn(random));
    PatchScene s(mesh, .2, 0, kModulus, .5);
    s.add(grain(k), 1000, Vec3::Zero());
    const Vec3 up = (mesh.nodes[mesh.quads[40][1]] - mesh.nodes[mesh.quads[40][0]])
                        .cross(mesh.nodes[mesh.quads[40][3]] - mesh.nodes[mesh.quads[40][0]])
                        .normalized();
    sink(s, 0, up, mesh.nodes[mesh.quads[40][0]], random_turn(random), .05);
    s.evaluate_afresh();
    s.bodies.v[0] = random.direction();  // so that there is friction
    s.bodies.turn[0] = 1e-3 * random.direction();
    for (Vec3& v : s.patch.velocity) v = random.direction();
    s.evaluate(1e-3);
    const Vec3 f = s.bodies.force[0];
    ASSERT_GT(s.contacts.friction[0].norm(), 1e-3 * f.norm());
    Vec3 moment = Vec3::Zero();
    double sum = 0;
    for (int i = 0; i < s.patch.carried; ++i) {
      moment += (s.patch.node[i] - s.bodies.x[0]).cross(s.patch.force[i]);
      sum += s.patch.force[i].norm();
    }
    expect_near(s.nodal_sum(), -f, 1e-14 * sum, "force");
    expect_near(moment, -s.bodies.torque[0], 1e-14 * sum, "moment");
  }
}

TEST(Seam, grain_at_the_seam_feels_as_inside) {
  const Vec3 period(2, 0, 0);
  const Mesh mesh = flat_mesh(8, 6, -1, 1, -1, 1);
  for (int k = 0; k < 10; ++k) {
    Answer inside, seam;
    for (const bool at_seam : {false, true}) {
      PatchScene s(mesh, .1, .3, kModulus, 0, "stored_energy", period);
      s.add(grain(k), 1000, Vec3::Zero());
      sink(s, 0, {0, 0, 1}, {at_seam ? 1.07 : .07, .2, 0}, turn_about({1, 2, 3}, k), .03);
      s.evaluate_afresh();
      (at_seam ? seam : inside) = {s.bodies.force[0], s.bodies.torque[0]};
      expect_near(s.nodal_sum(), -s.bodies.force[0], 1e-14 * s.bodies.force[0].norm(), "nodes");
    }
    ASSERT_GT(inside.force.norm(), 0);
    expect_near(seam.force, inside.force, 1e-11 * inside.force.norm(), "force");
    expect_near(seam.torque, inside.torque, 1e-11 * inside.force.norm(), "torque");
  }
}

TEST(Skirt, grain_over_the_border_feels_an_endless_surface) {
  for (const auto& at : {Vec3(.95, .1, 0), Vec3(1.04, -.2, 0), Vec3(.99, 1.01, 0)})
    for (int k = 0; k < 6; ++k) {
      Answer ends, goes_on;
      for (const bool ended : {false, true}) {
        const Mesh mesh = ended ? flat_mesh(8, 8, -1, 1, -1, 1) : flat_mesh(16, 16, -2, 2, -2, 2);
        PatchScene s(mesh, .1, ended ? .8 : 0, kModulus);
        s.add(grain(k), 1000, Vec3::Zero());
        sink(s, 0, {0, 0, 1}, at, turn_about({1, 2, 3}, k), .03);
        s.evaluate_afresh();
        (ended ? ends : goes_on) = {s.bodies.force[0], s.bodies.torque[0]};
        expect_near(s.nodal_sum(), -s.bodies.force[0], 1e-13 * s.bodies.force[0].norm(), "nodes");
      }
      ASSERT_GT(ends.force.norm(), 0);
      expect_near(ends.force, goes_on.force, 1e-11 * ends.force.norm(), "force");
      expect_near(ends.torque, goes_on.torque, 1e-11 * ends.force.norm(), "torque");
    }
}

// The border moves down: the skirt goes along.
TEST(Skirt, follows_its_border) {
  PatchScene s(flat_mesh(4, 4, -1, 1, -1, 1), .1, .5, kModulus);
  for (int i = 0; i < s.patch.carried; ++i) {
    s.patch.node[i].z() -= .01 * s.patch.node[i].x();
    s.patch.velocity[i] = s.patch.node[i];
  }
  move_skirt(s.patch);
  ASSERT_GT(s.patch.node.size(), static_cast<std::size_t>(s.patch.carried));
  for (std::size_t i = s.patch.carried; i < s.patch.node.size(); ++i) {
    const Vec3 p = s.patch.node[i], m = s.patch.node[s.patch.master[i]];
    EXPECT_EQ(p.z(), m.z());
    EXPECT_EQ(s.patch.velocity[i], m);
    const Vec3 out = p - m;
    EXPECT_NEAR(out.cwiseAbs().maxCoeff(), .5, 1e-8);
  }
}

// Pulled to and fro, sticking and slipping: the way on the patch is that on the rigid box.
TEST(Friction, sticks_and_slips_as_on_a_rigid_box) {
  const double E = 1e7, mu = .4, m = 1000 * .2 * .2 * .1, g = 9.81;
  const double depth = m * g / (.7522527780636751 * E * .2);
  const Vec3 x(.013, .027, .05 - depth);
  const std::uint8_t moves = kMoveX | kMoveY | kMoveZ;
  const auto pull = [&](double t) -> Vec3 {
    return 4 * mu * m * g * Vec3(std::sin(40 * t), .4 * std::sin(27 * t), 0);
  };
  Scene box(E, mu);
  box.context.gravity = {0, 0, -g};
  box.add_block({.2, .2, .1}, 1000, x, Quat::Identity(), moves);
  box.add_floor(3, 1);
  box.prepare();
  box.context.dt = 1e-4;
  PatchScene patch(flat_mesh(20, 20, -1, 1, -1, 1), .02, 0, E, mu);
  patch.context.gravity = {0, 0, -g};
  patch.add(make_box({.2, .2, .1}), 1000, x, Quat::Identity(), moves);
  patch.evaluate_afresh();
  patch.context.dt = 1e-4;
  double far = 0, slipped = 0;
  for (int k = 0; k < 3000; ++k) {
    box.bodies.applied_force[0] = patch.bodies.applied_force[0] = pull(box.time + 1e-4);
    box.step();
    patch.step();
    far = std::max(far, (box.bodies.x[0] - patch.bodies.x[0]).norm());
    slipped = std::max(slipped, (box.bodies.x[0] - x).norm());
  }
  EXPECT_GT(slipped, .02);
  EXPECT_LT(far, 1e-11 * slipped);
}

TEST(Friction, counts_the_motion_of_the_surface) {
  const double E = 1e7, dt = 1e-3;
  for (const bool together : {true, false}) {
    PatchScene s(flat_mesh(20, 20, -1, 1, -1, 1), .05, 0, E, .5);
    s.add(make_box({.2, .2, .2}), 1000, {.013, .027, .1 - .005});
    s.evaluate_afresh();
    const Vec3 v(1e-3, -2e-3, 0);
    for (Vec3& node : s.patch.velocity) node = v;
    s.bodies.v[0] = together ? v : Vec3(Vec3::Zero());
    s.evaluate(dt);
    const Vec3 expected = together ? Vec3(Vec3::Zero()) : Vec3(.25 * kShaoFactor * E * .2 * dt * v);
    expect_near(s.contacts.friction[0], expected, 1e-6 * kShaoFactor * E * .2 * dt * v.norm(),
                "friction");
  }
}

// What friction puts on the nodes has no moment about the centroid of the touched surface, and does
// the work of that point.
TEST(Friction, acts_where_the_surface_is_touched) {
  PatchScene s(flat_mesh(20, 20, -1, 1, -1, 1), .05, 0, 1e7, .5);
  s.add(grain(3), 1000, Vec3::Zero());
  sink(s, 0, {0, 0, 1}, {.013, .027, 0}, turn_about({1, 2, 3}, 2), .03);
  s.evaluate_afresh();
  std::vector<Vec3> change = s.patch.force;  // of the nodes' forces, by friction
  Mat3 stretch;
  stretch << .1, .3, 0, -.2, .4, 0, 0, 0, 0;
  for (std::size_t i = 0; i < s.patch.node.size(); ++i)
    s.patch.velocity[i] = stretch * s.patch.node[i];
  s.evaluate(1e-2);
  const Vec3 friction = s.contacts.friction[0], point = s.contacts.point[0];
  ASSERT_GT(friction.norm(), 1e-3 * s.contacts.normal_force[0].norm());
  Vec3 moment = Vec3::Zero();
  double power = 0, size = 0;
  for (int i = 0; i < s.patch.carried; ++i) {
    change[i] = s.patch.force[i] - change[i];
    moment += (s.patch.node[i] - point).cross(change[i]);
    power += s.patch.velocity[i].dot(change[i]);
    size += s.patch.force[i].norm();
  }
  expect_near(moment, Vec3::Zero(), 1e-13 * size, "moment");
  EXPECT_NEAR(power, -friction.dot(stretch * point), 1e-13 * size);
}

TEST(Patch, refuses_what_has_no_shell) {
  Mesh folded = flat_mesh(2, 1, -1, 1, -1, 1);  // folded flat: no inside
  for (Vec3& p : folded.nodes)
    if (p.x() > .5) p = Vec3(-1, p.y(), -1e-3);
  EXPECT_THROW(make_patch("sleeper", 0, folded.nodes, folded.quads, .1, 0, Vec3::Zero()),
               InputError);
  Mesh line = flat_mesh(1, 1, 0, 1, 0, 0);
  EXPECT_THROW(make_patch("sleeper", 0, line.nodes, line.quads, .1, 0, Vec3::Zero()), InputError);
  // Cells smaller than the shell is deep, at an edge: the shell turns inside out.
  const Mesh fine = edge_mesh(20, 20, 1);
  EXPECT_THROW(make_patch("sleeper", 0, fine.nodes, fine.quads, .2, 0, Vec3::Zero()), InputError);
  EXPECT_THROW(make_patch_forces("hertz", false), InputError);
}

// Deeper than the shell reaches is refused, not let through.
TEST(Patch, names_a_grain_that_goes_through) {
  PatchScene s(flat_mesh(6, 6, -1, 1, -1, 1), .05, 0, kModulus);
  s.add(grain(0), 1000, Vec3::Zero());
  sink(s, 0, {0, 0, 1}, {.1, .1, 0}, Quat::Identity(), .07);
  try {
    s.evaluate_afresh();
    FAIL() << "accepted";
  } catch (const RunError& e) {
    EXPECT_NE(std::string(e.what()).find("grain 0"), std::string::npos) << e.what();
    EXPECT_NE(std::string(e.what()).find("patch"), std::string::npos) << e.what();
  }
}

// The search forgets nothing: friction lives on over searches and element edges.
TEST(Search, keeps_history) {
  PatchScene s(flat_mesh(20, 20, -1, 1, -1, 1), .05, 0, kModulus, .5);
  for (int k = 0; k < 3; ++k)
    s.add(make_box({.3, .3, .3}), 1000, {-.5 + .5 * k, .02 * k, .15 - .005});
  s.evaluate_afresh();
  for (int k = 0; k < 3; ++k) s.bodies.v[k] = Vec3(.1 * (k + 1), 0, 0);
  s.evaluate(1e-3);
  const PatchContacts before = s.contacts;
  search_patch(s.bodies, s.shapes, s.patch, s.context, .3, s.contacts);
  ASSERT_EQ(s.contacts.size(), 3);
  ASSERT_GT(s.contacts.triangle.size(), before.triangle.size());
  for (int k = 0; k < 3; ++k) {
    EXPECT_GT(before.friction[k].norm(), 0);
    EXPECT_EQ(s.contacts.friction[k], before.friction[k]);
    EXPECT_EQ(s.contacts.arm[k], before.arm[k]);
    EXPECT_EQ(s.contacts.touching[k], 1);
  }
  const Vec3 force = s.bodies.force[1];
  s.evaluate(0);
  EXPECT_EQ(s.bodies.force[1], force);
}

}  // namespace
}  // namespace trackbed::dem
