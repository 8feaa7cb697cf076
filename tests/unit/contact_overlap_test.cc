// Overlap volumes and moments with known answers, degenerate positions, and what must not matter:
// the order of the bodies, rigid motions, the frame, the way the view was made.
#include <gtest/gtest.h>

#include "dem/contact/overlap.h"
#include "tests/verification/contact_support.h"

namespace trackbed::dem::test {
namespace {

const Polyhedron kCube = make_box(Vec3(1, 1, 1));

struct Pair {
  ShapeTable table;
  Pose pa{Mat3::Identity(), Vec3::Zero()}, pb{Mat3::Identity(), Vec3::Zero()};
  Pair(const Polyhedron& a, const Polyhedron& b) { table.add(as_is(a)), table.add(as_is(b)); }
  ConvexView a() const { return table.view(0); }
  ConvexView b() const { return table.view(1); }

  Contact contact(const Vec3& axis) const { return evaluate(a(), pa, b(), pb, axis); }
  double volume(const Vec3& axis) const { return contact(axis).volume; }
  void move(const Mat3& R, const Vec3& x) {
    for (Pose* p : {&pa, &pb}) p->R = R * p->R, p->x = R * p->x + x;
  }
};

// V for many frames, both orders, and after rigid motions.
void expect_volume(Pair pair, double expected, double tolerance = 1e-12) {
  Random random(7);
  for (int k = 0; k < 30; ++k) {
    const Vec3 axis = k == 0 ? Vec3(0, 0, 1) : random.direction();
    EXPECT_NEAR(pair.volume(axis), expected, tolerance * std::max(expected, 1e-30)) << k;
    const Contact other = evaluate(pair.b(), pair.pb, pair.a(), pair.pa, -axis);
    EXPECT_NEAR(other.volume, expected, tolerance * std::max(expected, 1e-30)) << k;
    if (k >= 10) pair.move(random_rotation(random), 0.1 * random.direction());
  }
}

TEST(OverlapVolume, CubeTurnedByHalfARightAngle) {
  Pair p(kCube, kCube);
  p.pb.R = rotation(Vec3(0, 0, M_PI / 4));
  expect_volume(p, 2 * std::sqrt(2.0) - 2);
}

TEST(OverlapVolume, ShiftedCubes) {
  Pair p(kCube, kCube);
  p.pb.x = Vec3(.3, .2, .1);
  expect_volume(p, .504);
}

TEST(OverlapVolume, CubeAndOctahedron) {
  const double h = .75;
  Pair p(kCube, convex_hull({{h, 0, 0}, {-h, 0, 0}, {0, h, 0}, {0, -h, 0}, {0, 0, h}, {0, 0, -h}}));
  expect_volume(p, .5);
}

TEST(OverlapVolume, CrossedEdges) {
  for (double phi : {M_PI / 2, 1.0, 0.3}) {
    for (double d : {0.1, 1e-3, 1e-6}) {
      Pair p(kCube, kCube);
      const double r = std::sqrt(.5);
      p.pa.R = rotation(Vec3(0, M_PI / 4, 0));  // edge along y, up
      p.pb.R = rotation(Vec3(0, 0, phi)) * rotation(Vec3(0, M_PI / 4, 0));
      p.pb.x = Vec3(0, 0, 2 * r - d);
      const double expected = 2.0 / 3 * d * d * d / std::sin(phi);
      EXPECT_NEAR(p.volume(Vec3(0, 0, 1)), expected, 2e-12 * expected + 4e-15 * d * d / .3);
      if (d == 0.1) expect_volume(p, expected);
    }
  }
}

TEST(OverlapVolume, VertexPiercedByAFace) {
  const Mat3 up = Quat::FromTwoVectors(Vec3(1, 1, 1), Vec3(0, 0, 1)).toRotationMatrix();
  for (double h : {0.1, 1e-3}) {
    Pair p(kCube, make_box(Vec3(3, 3, 3)));
    p.pa.R = up;
    p.pb.x = Vec3(0, 0, 1.5 + std::sqrt(3.) / 2 - h);
    const double expected = std::sqrt(3.) / 2 * h * h * h;
    EXPECT_NEAR(p.volume(Vec3(0, 0, 1)), expected, 1e-12 * expected + 1e-15 * h * h);
  }
}

TEST(OverlapVolume, WithItself) {
  Random random(3);
  for (int k = 0; k < 20; ++k) {
    const Polyhedron body = k == 0 ? kCube : random_hull(random, 6 + k);
    Pair p(body, body);
    const double volume = mass_properties(body).volume;
    p.pa.R = p.pb.R = random_rotation(random);
    expect_volume(p, volume);
    // The same place reached by different roundings of the pose.
    const Mat3 turn = random_rotation(random);
    p.pb.R = (turn.transpose() * (turn * p.pb.R)).eval();
    expect_volume(p, volume);
  }
}

TEST(OverlapVolume, OneInsideTheOther) {
  Pair p(kCube, scaled(kCube, 0.25));
  expect_volume(p, 1. / 64);
  p.pb.R = rotation(Vec3(.3, .2, .9));
  expect_volume(p, 1. / 64);
  p.pb.R = Mat3::Identity();
  p.pb.x = Vec3(.375, .375, .375);  // three faces coincide
  expect_volume(p, 1. / 64);
}

TEST(OverlapVolume, CoincidentFacesOfShiftedCubes) {
  Pair p(kCube, kCube);
  p.pb.x = Vec3(0, 0, .9);  // four sides coincide
  expect_volume(p, .1);
  p.pb.x = Vec3(.25, 0, .75);  // two sides coincide
  expect_volume(p, .75 * .25);
  p.pb.x = Vec3(0, 0, .9);
  p.move(rotation(Vec3(1, 2, 3)), Vec3(.1, .2, .3));
  expect_volume(p, .1);
}

TEST(OverlapVolume, NearlyCoincidentFaces) {  // tilted by 1e-15 ... 1e-3 about an axis in the face
  for (double tilt = 1e-16; tilt < 2e-3; tilt *= 3) {
    Pair p(kCube, kCube);
    p.pb.R = rotation(Vec3(tilt, 0, 0));
    const double exact = 1 - std::tan(tilt) / 2;  // less four thin wedges, to first order
    EXPECT_NEAR(p.volume(Vec3(0, 0, 1)), exact, 1e-12 + tilt * tilt) << tilt;
    EXPECT_NEAR(p.volume(Vec3(1, .2, .3)), exact, 1e-12 + tilt * tilt) << tilt;
  }
}

TEST(OverlapVolume, NothingWhenOnlyTouching) {
  Pair p(kCube, kCube);
  for (const Vec3& x : {Vec3(0, 0, 1), Vec3(0, 1, 1), Vec3(1, 1, 1), Vec3(.3, .2, 1),
                        Vec3(0, .5, 1), Vec3(2, 0, 0), Vec3(0, 0, 1 + 1e-9)}) {
    p.pb.x = x;
    for (const Vec3& axis : {Vec3(0, 0, 1), Vec3(.1, .2, 1), Vec3(1, 1, 1)}) {
      const Contact c = p.contact(axis);
      EXPECT_LT(c.volume, 1e-15);
      EXPECT_FALSE(std::isnan(c.energy));
      EXPECT_LT(c.energy, 1e-20);
    }
  }
}

TEST(OverlapVolume, SliversAndDuplicateVertices) {
  Pair needle(make_box(Vec3(1, 1e-3, 1e-3)), kCube);
  needle.pa.x = Vec3(0, 0, .5);
  expect_volume(needle, 1 * 1e-3 * .5e-3, 1e-10);  // random frames: 1e-16 of 1 against 1e-3
  needle.pa.R = rotation(Vec3(0, .7, 0));
  needle.pa.x = Vec3::Zero();
  expect_volume(needle, 1e-6, 1e-10);

  Polyhedron spare = kCube;  // vertices that no face uses change nothing
  spare.vertices.push_back(spare.vertices[0]);
  spare.vertices.push_back(Vec3::Zero());
  Pair p(spare, kCube);
  p.pb.x = Vec3(.3, .2, .1);
  expect_volume(p, .504);

  Polyhedron split = kCube;  // nearly coplanar: a face in two triangles, its corner 1e-13 lower
  split.vertices[7] -= Vec3(0, 0, 1e-13);
  split.faces.back() = {4, 5, 7};
  split.faces.push_back({4, 7, 6});
  Pair q(split, kCube);
  q.pb.x = Vec3(.3, .2, .1);
  expect_volume(q, .504);
}

TEST(OverlapMoments, OfABox) {
  Pair p(kCube, make_box(Vec3(2, 2, 2)));
  p.pb.x = Vec3(.9, .6, 1.2);  // a box [-.1,.5] x [-.4,.5] x [.2,.5]
  const Vec3 centre(.2, .05, .35), edges(.6, .9, .3);
  const double volume = edges.prod();
  Random random(5);
  for (int k = 0; k < 20; ++k) {
    const Contact c = p.contact(random.direction());
    EXPECT_NEAR(c.volume, volume, 1e-14);
    EXPECT_LT((c.centroid - centre).norm(), 1e-14);
    const Mat3 second = c.frame.axes * c.shape.second_moment * c.frame.axes.transpose();
    const Mat3 exact = (volume / 12 * edges.cwiseAbs2()).asDiagonal();
    EXPECT_LT((second - exact).cwiseAbs().maxCoeff(), 1e-15);
    EXPECT_LT((c.area - Vec3(.9 * .3, .6 * .3, .6 * .9)).norm(), 1e-14);
  }
}

TEST(OverlapPieces, FormAClosedSurface) {
  Random random(11);
  OverlapWorkspace work;
  for (int k = 0; k < 200; ++k) {
    Pair p(random_hull(random, 8 + k % 12), random_hull(random, 8 + k % 9));
    p.pb = touching_pose(random, p.a(), p.pa, p.b(), std::pow(10, random.uniform(-6, -0.5)));
    work.clear();
    OverlapMoments m;
    const ContactFrame frame = contact_frame(p.a(), p.pa, p.b(), p.pb, random.direction());
    ASSERT_TRUE(overlap(p.a(), p.pa, p.b(), p.pb, frame, work, m));
    Vec3 sum = Vec3::Zero();
    double total = 0;
    for (const auto* pieces : {&work.a_pieces, &work.b_pieces})
      for (const OverlapPiece& piece : *pieces) sum += piece.area, total += piece.area.norm();
    EXPECT_LT(sum.norm(), 1e-12 * total + 1e-13 * std::sqrt(total)) << k;
  }
}

// The ways through the kernel: with adjacency, without, and that for bodies of any size.
TEST(OverlapPieces, EveryWayGivesTheSame) {
  Random random(13);
  for (int k = 0; k < 200; ++k) {
    Pair p(random_hull(random, 15), k % 3 ? random_hull(random, 15) : kCube);
    p.pb = touching_pose(random, p.a(), p.pa, p.b(), 0.01);
    const Vec3 axis = random.direction();
    ConvexView a = p.a(), b = p.b();
    const Contact fast = evaluate(a, p.pa, b, p.pb, axis);
    ASSERT_TRUE(fast.touching);
    for (int way = 0; way < 2; ++way) {
      for (ConvexView* v : {&a, &b}) {
        v->neighbor = v->neighbor_begin = nullptr, v->vertex_faces = nullptr;
        v->corners = nullptr, v->planes_padded = false;
        if (way == 1 && v->vertices == 15) v->padded = v->vertices;  // no whole eights: any size
      }
      const Contact other = evaluate(a, p.pa, b, p.pb, axis);
      EXPECT_NEAR(fast.volume, other.volume, 1e-11 * fast.volume);
      // Random frames cost thin overlaps digits.
      EXPECT_LT((fast.force_a - other.force_a).norm(), 1e-9 * fast.force_a.norm());
      EXPECT_LT((fast.torque_a - other.torque_a).norm(), 1e-9 * fast.force_a.norm());
    }
  }
}

TEST(OverlapPieces, BodiesOfManyFaces) {
  Random random(19);
  for (int k = 0; k < 10; ++k) {
    Pair p(random_hull(random, 300), random_hull(random, 40));
    p.pb = touching_pose(random, p.a(), p.pa, p.b(), 0.05);
    const Contact c = p.contact(p.pb.x);
    ASSERT_TRUE(c.touching);
    EXPECT_LT((c.force_a + c.force_b).norm(), 1e-10 * c.force_a.norm());
    const Contact other = evaluate(p.b(), p.pb, p.a(), p.pa, -p.pb.x);
    EXPECT_NEAR(c.volume, other.volume, 1e-11 * c.volume);
  }
}

TEST(OverlapMoments, AddUpOverCells) {
  // A cube as eight cells against one body.
  Random random(17);
  const Polyhedron cell = make_box(Vec3(.5, .5, .5));
  int touching = 0;
  for (int k = 0; k < 20; ++k) {
    Pair p(random_hull(random, 16), kCube);
    p.pa.x = Vec3(random.uniform(-.3, .3), random.uniform(-.3, .3), -.9);
    p.pa.R = random_rotation(random);
    const Contact whole = p.contact(Vec3(0, 0, 1));
    if (!whole.touching) continue;
    ++touching;
    ShapeTable table;
    table.add(as_is(cell));
    OverlapWorkspace work;
    OverlapMoments m;
    const ContactFrame frame = contact_frame(p.a(), p.pa, p.b(), p.pb, Vec3(0, 0, 1));
    for (int i = 0; i < 8; ++i) {
      const Pose pose{Mat3::Identity(),
                      Vec3(i & 1 ? .25 : -.25, i & 2 ? .25 : -.25, i & 4 ? .25 : -.25)};
      overlap(p.a(), p.pa, table.view(0), pose, frame, work, m);
    }
    const OverlapShape s = make_shape(m, work);
    EXPECT_NEAR(s.volume, whole.volume, 1e-13 * whole.volume);
    EXPECT_LT((s.area - whole.shape.area).norm(), 1e-13);
    EXPECT_LT((s.second_moment - whole.shape.second_moment).norm(),
              1e-12 * whole.shape.second_moment.norm());
  }
  EXPECT_GT(touching, 10);
}

}  // namespace
}  // namespace trackbed::dem::test
