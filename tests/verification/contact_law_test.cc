// The stored-energy law: force and torque are -grad U, Eq. 17 face on face, continuity where codes
// chatter, closed loops, scale; and the seed law's value where it is not conservative.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "dem/contact/laws/shao2017.h"
#include "dem/contact/laws/stored_energy.h"
#include "tests/verification/contact_support.h"

namespace trackbed::dem::test {
namespace {

const double kShao = 4 / (3 * std::sqrt(M_PI));
const Mat3 kUpright = Mat3::Identity();

// The same family with P = 1, to compare with.
struct TraceLaw {
  NormalResponse operator()(const OverlapShape& s, const PairMaterial& m) const {
    return stored_energy_response<1>(s, m.modulus);
  }
};

struct Scene {
  ShapeTable table;
  Pose pa{kUpright, Vec3::Zero()}, pb{kUpright, Vec3::Zero()};
  Scene(const Polyhedron& a, const Polyhedron& b) { table.add(as_is(a)), table.add(as_is(b)); }
  template <class Law = StoredEnergyLaw>
  Contact contact(const Vec3& axis, const Law& law = Law()) const {
    OverlapWorkspace work;
    return evaluate(table.view(0), pa, table.view(1), pb, axis, law, material(1), work);
  }
};

Polyhedron box(double x, double y, double z) { return make_box(Vec3(x, y, z)); }

// Force and torque on a by central differences of U, fourth order.
template <class Law>
void expect_gradient(Scene scene, const Vec3& axis, double h, double tolerance) {
  const Contact c = scene.contact<Law>(axis);
  ASSERT_TRUE(c.touching);
  const Pose start = scene.pa;
  const double lever = scene.table.view(0).radius;
  const auto slope = [&](const Vec3& shift, const Vec3& turn) {
    const auto energy = [&](double s) {
      scene.pa = {rotation(s * turn) * start.R, start.x + s * shift};
      return scene.contact<Law>(axis).energy;
    };
    return (8 * (energy(h) - energy(-h)) - (energy(2 * h) - energy(-2 * h))) / (12 * h);
  };
  for (int i = 0; i < 3; ++i) {
    const Vec3 e = Vec3::Unit(i);
    EXPECT_NEAR(-slope(e, Vec3::Zero()), c.force_a(i), tolerance * c.force_a.norm());
    EXPECT_NEAR(-slope(Vec3::Zero(), e / lever), c.torque_a(i) / lever,
                tolerance * c.force_a.norm());
  }
  EXPECT_LT((c.force_a + c.force_b).norm(), 1e-10 * c.force_a.norm());
  EXPECT_LT(
      (c.torque_a + c.torque_b + scene.pa.x.cross(c.force_a) + scene.pb.x.cross(c.force_b)).norm(),
      1e-10 * c.force_a.norm());
}

TEST(StoredEnergy, ForceAndTorqueAreTheGradient) {
  Random random(1);
  for (int k = 0; k < 60; ++k) {
    Scene s(random_hull(random, 6 + k % 15), random_hull(random, 6 + k % 11));
    s.pa = {random_rotation(random), random.direction()};
    const double share = std::pow(10, random.uniform(-3, -0.5));
    s.pb = touching_pose(random, s.table.view(0), s.pa, s.table.view(1), share);
    const Contact c = s.contact(s.pb.x - s.pa.x);
    // A step that no vertex of the overlap is likely to cross.
    const double h = 2e-4 * c.shape.depth;
    expect_gradient<StoredEnergyLaw>(s, c.area.normalized(), h, 2e-6);
    if (k % 4 == 0) expect_gradient<TraceLaw>(s, c.area.normalized(), h, 2e-6);
  }
}

TEST(StoredEnergy, FaceOnFaceIsEquation17) {
  for (double d : {1e-1, 1e-2, 1e-4, 1e-8}) {
    Scene s(box(1, 1, 1), box(2, 2, 2));
    s.pb.x = Vec3(.3, -.2, 1.5 - d);
    s.pa.R = rotation(Vec3(0, 0, .4));
    const Contact c = s.contact(Vec3(.01, .02, 1));
    const double expected = kShao * d;  // V = d
    // dbar = d (1 + 2 d^4)^(-1/4); noise 1e-16 of the depth
    EXPECT_NEAR(-c.force_a.z(), expected, expected * (20 * std::pow(d, 4) + 1e-12 + 1e-15 / d));
    EXPECT_NEAR(c.energy, expected * d / 2, expected * d * (std::pow(d, 4) + 1e-12 + 1e-15 / d));
    EXPECT_LT(c.force_a.head<2>().norm(), 1e-12 * expected + 1e-15);
    EXPECT_LT((c.torque_a).norm(), expected * (1e-12 + 1e-14 / d));
    EXPECT_NEAR(c.stiffness, 1.2 * kShao, 1e-10);  // 1.2 dF/dd: the bound of the worst shape
    const Contact seed = s.contact<Shao2017Law>(Vec3(0, 0, 1));
    EXPECT_NEAR(-seed.force_a.z(), expected, expected * (1e-12 + 2e-15 / d));
  }
}

TEST(StoredEnergy, FlatOverlapKeepsItsDigits) {  // depth/width 1e-9, grain sizes, any orientation
  Random random(2);
  for (int k = 0; k < 50; ++k) {
    Scene s(box(.05, .05, .05), box(.05, .05, .05));
    const double d = 5e-11;
    const Mat3 R = k == 0 ? kUpright : random_rotation(random);
    s.pa = {R, Vec3(.2, .3, .1)};
    s.pb = {R, s.pa.x + R * Vec3(.01, .005, .05 - d)};
    const Contact c = s.contact(R.col(2) + 1e-3 * random.direction());
    const double gap = R.col(2).dot(s.pb.x - s.pa.x) - .05;  // positions are rounded too
    const double area = .04 * .045, expected = kShao * std::sqrt(area) * -gap;
    EXPECT_NEAR(c.force_a.norm(), expected, (k == 0 ? 1e-6 : 3e-6) * expected) << k;
  }
}

// Of two lumps far apart, as where an edge lies on two waves, that stand across the axes at any angle:
// the smallest of the moments to what rounding leaves of it, eps L^2/T^2.
TEST(StoredEnergy, NeedlesAcrossTheAxesKeepTheirDigits) {
  const Vec3 size(1, 1e-4, 5e-5);
  OverlapShape s;
  s.volume = 1e-9, s.area = Vec3(0, 0, 1e-5);
  s.second_moment = s.volume / 12 * size.cwiseAbs2().asDiagonal().toDenseMatrix();
  const double upright = stored_energy_response<2>(s, 1).energy;
  const double exact =
      kShao / 2 * std::sqrt(1e-9) * std::pow(std::pow(1e-4, -4) + std::pow(5e-5, -4), -3. / 8);
  EXPECT_NEAR(upright, exact, 1e-9 * exact);
  Random random(4);
  for (const double tilt : {0., 1e-4, .0074, .3, 2.})
    for (int k = 0; k < 50; ++k) {
      const Mat3 R =
          rotation(tilt * random.direction()) * rotation(random.uniform(0, 6) * Vec3::UnitZ());
      OverlapShape turned = s;
      turned.second_moment = R * s.second_moment * R.transpose();
      EXPECT_NEAR(stored_energy_response<2>(turned, 1).energy, exact, 3e-6 * exact) << tilt;
    }
}

TEST(StoredEnergy, SmoothThroughTiltZero) {
  // A unit cube in a wide face at depth d: torque is linear in the tilt, force does not jump.
  const double d = 1e-4;
  Scene s(box(1, 1, 1), box(4, 4, 4));
  const auto tilted = [&](double t) {
    s.pa.R = rotation(Vec3(t, 0, 0));
    s.pb.x = Vec3(0, 0, 2.5 - d);
    return s.contact(Vec3(0, 0, 1));
  };
  const double force = -tilted(0).force_a.z();
  EXPECT_NEAR(force, kShao * d, 1e-11 * force);
  const double stiffness = -tilted(1e-7).torque_a.x() / 1e-7;
  EXPECT_GT(stiffness, 0);
  for (double t = 1e-14; t < 2e-5; t *= 10)
    for (double sign : {-1., 1.}) {
      const Contact c = tilted(sign * t);
      EXPECT_NEAR(-c.force_a.z(), force, force * (1e-11 + 2 * std::pow(t / d, 2) + t)) << t;
      EXPECT_NEAR(-c.torque_a.x(), stiffness * sign * t,
                  stiffness * t * (1e-3 + 10 * std::pow(t / d, 2)) + 1e-12 * force)
          << t;
    }
  for (double t : {1e-4, 1e-3}) {  // partly lifted: still a restoring torque, force area-true
    EXPECT_LT(tilted(t).torque_a.x(), 0);
    EXPECT_GT(-tilted(t).force_a.z(), force);
  }
}

TEST(StoredEnergy, EdgesCrossingAtEveryAngle) {
  // Edges of two beams, crossing angle 90 degrees to 1e-12 degrees; the limit is edge along edge.
  const double d = 1e-3, r = std::sqrt(.5);
  Scene s(box(1, 1, 1), box(1, 1, 1));
  s.pa.R = rotation(Vec3(0, M_PI / 4, 0));
  double last = 0;
  for (double degrees = 90; degrees > 1e-12; degrees *= 0.97) {
    s.pb.R = rotation(Vec3(0, 0, degrees * M_PI / 180)) * rotation(Vec3(0, M_PI / 4, 0));
    s.pb.x = Vec3(0, 0, 2 * r - d);
    const Contact c = s.contact(Vec3(0, 0, 1));
    ASSERT_TRUE(c.touching);
    EXPECT_NEAR(c.force_a.normalized().norm(), 1, 1e-14);
    EXPECT_LT(c.force_a.z(), 0);
    EXPECT_LT(c.force_a.head<2>().norm(), 1e-6 * c.force_a.norm());
    EXPECT_NEAR(c.frame.axes.col(2).norm(), 1, 1e-14);
    const double force = c.force_a.norm();
    if (last > 0) {
      EXPECT_LT(std::abs(force / last - 1), 0.04) << degrees;
    }
    last = force;
  }
  s.pb.R = s.pa.R;
  EXPECT_NEAR(s.contact(Vec3(0, 0, 1)).force_a.norm(), last, 1e-9 * last);
}

TEST(StoredEnergy, VertexOverVertexAndEdge) {
  const Mat3 up = Quat::FromTwoVectors(Vec3(1, 1, 1), Vec3(0, 0, 1)).toRotationMatrix();
  const Mat3 down = Quat::FromTwoVectors(Vec3(1, 1, 1), Vec3(0, 0, -1)).toRotationMatrix();
  const Mat3 edge_down = rotation(Vec3(0, M_PI / 4, 0));
  for (const bool vertex : {true, false}) {
    Scene s(box(1, 1, 1), box(1, 1, 1));
    s.pa.R = up;
    s.pb.R = vertex ? down : edge_down;
    const double touch = std::sqrt(3.) / 2 + (vertex ? std::sqrt(3.) / 2 : std::sqrt(.5));
    double last = 1;
    for (double d : {1e-2, 1e-4, 1e-6, 1e-8}) {
      s.pb.x = Vec3(0, 0, touch - d);
      const Contact c = s.contact(Vec3(0, 0, 1));
      EXPECT_TRUE(c.force_a.allFinite());
      EXPECT_LT(c.force_a.norm(), 3 * d * d);
      EXPECT_LT(c.force_a.norm(), last);
      last = c.force_a.norm();
    }
    // Passing over by +-1e-9: the energy has no jump.
    s.pb.x = Vec3(0, 0, touch - 1e-3);
    const double peak = s.contact(Vec3(0, 0, 1)).energy;
    for (const Vec3& side : {Vec3(1e-9, 0, 0), Vec3(0, 1e-9, 0), Vec3(1e-9, 1e-9, 0)})
      for (double sign : {-1., 1.}) {
        s.pb.x = Vec3(0, 0, touch - 1e-3) + sign * side;
        EXPECT_NEAR(s.contact(Vec3(0, 0, 1)).energy, peak, 1e-5 * peak);
      }
  }
}

TEST(StoredEnergy, ScaleDoesNotMatter) {
  Random random(4);
  for (int k = 0; k < 20; ++k) {
    const Polyhedron a = random_hull(random, 12), b = random_hull(random, 12);
    Scene one(a, b);
    one.pa.R = random_rotation(random);
    one.pb = touching_pose(random, one.table.view(0), one.pa, one.table.view(1), 0.01);
    const Contact c = one.contact(one.pb.x);
    for (double f : {1e-9, 1e-3, 1e6}) {
      Scene other(scaled(a, f), scaled(b, f));
      other.pa = one.pa, other.pb = one.pb;
      other.pb.x *= f;
      const Contact o = other.contact(other.pb.x);
      ASSERT_TRUE(o.touching);
      EXPECT_NEAR(o.energy, c.energy * f * f * f, 1e-10 * o.energy);
      EXPECT_LT((o.force_a - f * f * c.force_a).norm(), 1e-10 * o.force_a.norm());
      EXPECT_LT((o.torque_a - f * f * f * c.torque_a).norm(), 1e-10 * f * o.force_a.norm());
    }
  }
}

// Work on a cube moved around x0 -> x1, y0 -> y1, back; Gauss-Legendre along each side.
template <class Law>
double loop_work(const Polyhedron& a, const Polyhedron& b, const std::vector<Pose>& corners,
                 int pieces) {
  Scene s(a, b);
  static const double node[4] = {-.8611363115940526, -.3399810435848563, .3399810435848563,
                                 .8611363115940526};
  static const double weight[4] = {.3478548451374538, .6521451548625461, .6521451548625461,
                                   .3478548451374538};
  double work = 0;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Vec3 from = corners[k].x, to = corners[(k + 1) % corners.size()].x;
    for (int i = 0; i < pieces; ++i)
      for (int g = 0; g < 4; ++g) {
        const double t = (i + 0.5 + 0.5 * node[g]) / pieces;
        s.pa.x = from + t * (to - from);
        work += weight[g] / (2 * pieces) * s.contact<Law>(Vec3(0, 0, 1)).force_a.dot(to - from);
      }
  }
  return work;
}

TEST(ClosedLoop, WorkOfBothLaws) {
  // Cubes whose overlap is x by y by z: x from 0 to x1, y from y0 to 2 y0, and back.
  const double x0 = 1e-7, x1 = .4, y0 = .2, y1 = .4, z = .01;
  std::vector<Pose> corners;
  for (const auto& [x, y] :
       std::vector<std::pair<double, double>>{{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}})
    corners.push_back({kUpright, Vec3(x - 1, y - 1, z - 1)});
  const double stored = kShao / 2 * std::sqrt(x1 * y1) * z * z;
  // A smoother loop for the energy law: no corner of it where the overlap's edge is as thin as
  // 1e-7.
  std::vector<Pose> inner = corners;
  inner[0].x.x() = inner[3].x.x() = .1 - 1;
  EXPECT_NEAR(loop_work<StoredEnergyLaw>(box(1, 1, 1), box(1, 1, 1), inner, 40), 0, 1e-10 * stored);

  // Depth x under Eq. 17 of Shao 2017: k sqrt(z)/2 (x1^2-x0^2)(sqrt y1-sqrt y0), 29 % of the stored
  // energy.
  const double d0 = 1e-9, d1 = .01, length = .5;
  std::vector<Pose> seed;
  for (const auto& [d, y] :
       std::vector<std::pair<double, double>>{{d0, y0}, {d1, y0}, {d1, y1}, {d0, y1}})
    seed.push_back({kUpright, Vec3(length - 1, y - 1, d - 1)});
  const double gain =
      kShao * std::sqrt(length) / 2 * (d1 * d1 - d0 * d0) * (std::sqrt(y1) - std::sqrt(y0));
  const double work = loop_work<Shao2017Law>(box(1, 1, 1), box(1, 1, 1), seed, 10);
  EXPECT_NEAR(work, gain, 1e-10 * gain);
  const double energy = kShao / 2 * std::sqrt(length * y1) * d1 * d1;
  EXPECT_NEAR(work / energy, 1 - std::sqrt(.5), 1e-6);
  std::printf("closed loop, Shao 2017: %.4f of the stored energy\n", work / energy);
}

// What the header says about the two members of the family. Printed for the record.
struct Comparison {
  double tilt, vertex, rim;
};
template <class Law>
Comparison compare() {
  Comparison out;
  {  // tilt stiffness against that of a Winkler bed of the same k_n: k A/12 per unit area
    Scene s(box(1, 1, 1), box(4, 4, 4));
    const double d = 1e-3, t = 1e-6;
    s.pb.x = Vec3(0, 0, 2.5 - d);
    s.pa.R = rotation(Vec3(t, 0, 0));
    out.tilt = -s.contact<Law>(Vec3(0, 0, 1)).torque_a.x() / t / (kShao / 12);
  }
  {  // a cube's vertex against Eq. 17
    Scene s(box(1, 1, 1), box(4, 4, 4));
    const double d = 1e-2;
    s.pa.R = Quat::FromTwoVectors(Vec3(1, 1, 1), Vec3(0, 0, 1)).toRotationMatrix();
    s.pb.x = Vec3(0, 0, std::sqrt(.75) + 2 - d);
    const Contact c = s.contact<Law>(Vec3(0, 0, 1));
    out.vertex = c.force_a.norm() / (kShao * std::sqrt(c.volume * d));
    const NormalResponse r = Law()(c.shape, material(1));
    // Least pressure over b's face, at the centroid's foot: p0 + Q_zz z^2 and its corners.
    OverlapWorkspace work;
    OverlapMoments m;
    overlap(s.table.view(0), s.pa, s.table.view(1), s.pb, c.frame, work, m);
    double least = 1e300, most = -1e300;
    for (const Vec3& p : work.points) {
      const Vec3 y = p - c.shape.centroid;
      const double pressure = r.p0 + y.dot(r.Q * y);
      least = std::min(least, pressure), most = std::max(most, pressure);
    }
    out.rim = std::min(least, r.p0) / most;
  }
  return out;
}

TEST(StoredEnergy, TraceAndFrobeniusCompared) {
  const Comparison trace = compare<TraceLaw>(), frobenius = compare<StoredEnergyLaw>();
  std::printf("              tilt/Winkler  vertex/Eq.17  least p/largest p\n");
  std::printf("tr C^-1       %.6f      %.4f        %.3f\n", trace.tilt, trace.vertex, trace.rim);
  std::printf("(tr C^-2)^1/2 %.6f      %.4f        %.3f\n", frobenius.tilt, frobenius.vertex,
              frobenius.rim);
  // Thick slabs: error of Eq. 17 at d/a = 0.1.
  for (double d : {.1, .03}) {
    Scene s(box(1, 1, 1), box(4, 4, 4));
    s.pb.x = Vec3(0, 0, 2.5 - d);
    const double a = -s.contact<TraceLaw>(Vec3(0, 0, 1)).force_a.z() / (kShao * d) - 1,
                 b = -s.contact(Vec3(0, 0, 1)).force_a.z() / (kShao * d) - 1;
    std::printf("d/a %.2f: Eq. 17 error %.2e (trace) %.2e (Frobenius)\n", d, a, b);
    EXPECT_LT(std::abs(b), std::abs(a));
  }
  EXPECT_GT(frobenius.vertex, trace.vertex);
}

TEST(StoredEnergy, StiffnessBoundsTheTangent) {
  // The largest eigenvalue of -dF/dx over all directions, random pairs: at most the stated bound.
  Random random(6);
  double worst = 0, along = 0;
  for (int k = 0; k < 2000; ++k) {
    Scene s(random_hull(random, 6 + k % 15), random_hull(random, 6 + k % 11));
    s.pb = touching_pose(random, s.table.view(0), s.pa, s.table.view(1),
                         std::pow(10, random.uniform(-4, -1.5)));
    const Contact c = s.contact(s.pb.x);
    const Vec3 n = c.force_a.normalized();
    const double h = 1e-4 * c.shape.depth;
    const Pose start = s.pa;
    Mat3 tangent;
    for (int i = 0; i < 3; ++i) {
      s.pa.x = start.x + h * Vec3::Unit(i);
      const Vec3 plus = s.contact(c.area).force_a;
      s.pa.x = start.x - h * Vec3::Unit(i);
      tangent.col(i) = -(plus - s.contact(c.area).force_a) / (2 * h);
    }
    const double largest =
        Eigen::SelfAdjointEigenSolver<Mat3>(0.5 * (tangent + tangent.transpose()))
            .eigenvalues()
            .maxCoeff();
    worst = std::max(worst, largest / c.stiffness);
    along = std::max(along, n.dot(tangent * n) / c.stiffness);
  }
  std::printf("largest tangent/bound: %.3f, along the force %.3f\n", worst, along);
  EXPECT_LT(worst, 1);
}

TEST(StoredEnergy, NothingBelowTheNoise) {
  OverlapShape s;
  s.volume = 0, s.depth = 0;
  s.centroid.setZero(), s.second_moment.setZero(), s.area.setZero();
  for (int k = 0; k < 2; ++k) {
    const NormalResponse r = StoredEnergyLaw()(s, material(1)), q = Shao2017Law()(s, material(1));
    EXPECT_EQ(r.energy, 0);
    EXPECT_EQ(r.p0, 0);
    EXPECT_EQ(r.Q.norm(), 0);
    EXPECT_EQ(q.p0, 0);
    s.volume = std::nan("");
  }
}

TEST(NodalPressure, SumsToThePieceAndKeepsItsMoment) {
  Random random(8);
  const Polyhedron tetrahedron = convex_hull({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {.2, .2, 1}});
  for (int k = 0; k < 20; ++k) {
    Scene s(random_hull(random, 12), tetrahedron);
    s.pb = {rotation(Vec3(M_PI, 0, 0)), Vec3(-.3, .3, .85)};
    s.pa.R = random_rotation(random);
    OverlapWorkspace work;
    const Contact c = evaluate(s.table.view(0), s.pa, s.table.view(1), s.pb, Vec3(0, 0, 1),
                               StoredEnergyLaw(), material(1), work);
    if (!c.touching) continue;
    const NormalResponse r = StoredEnergyLaw()(c.shape, material(1));
    for (const OverlapPiece& piece : work.b_pieces) {
      const auto& face = s.table.shape(1).body.faces[piece.face];
      Vec3 corner[3];
      for (int i = 0; i < 3; ++i)
        corner[i] = c.frame.axes.transpose() *
                    (s.pb.R * s.table.shape(1).body.vertices[face[i]] + s.pb.x - c.frame.origin);
      const NodalForces nodal = nodal_pressure(work, piece, c.shape, r, corner);
      const PressureForce whole =
          integrate_pressure(work, std::vector<OverlapPiece>{piece}, c.shape, r);
      Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
      double share = 0;
      for (int i = 0; i < 3; ++i) {
        force += nodal.f[i], share += nodal.share[i];
        moment += (corner[i] - c.shape.centroid).cross(nodal.f[i]);
      }
      const double scale = c.force_a.norm();
      EXPECT_LT((force - whole.force).norm(), 1e-13 * scale);
      EXPECT_LT((moment - whole.moment).norm(), 1e-13 * scale);
      EXPECT_NEAR(share, piece.area.norm(), 1e-14);
    }
  }
}

}  // namespace
}  // namespace trackbed::dem::test
