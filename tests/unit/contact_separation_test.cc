// Separating axes: never a false "separated", found whenever the bodies are apart.
#include <gtest/gtest.h>

#include "dem/contact/separation.h"
#include "tests/verification/contact_support.h"

namespace trackbed::dem::test {
namespace {

TEST(SeparatingAxis, FindsGapsOfRandomPairs) {
  Random random(1);
  for (int k = 0; k < 2000; ++k) {
    ShapeTable table;
    table.add(as_is(random_hull(random, 5 + k % 20)));
    table.add(as_is(random_hull(random, 5 + k % 17)));
    const ConvexView a = table.view(0), b = table.view(1);
    const Pose pa{random_rotation(random), random.direction()};
    const double gap = std::pow(10, random.uniform(-9, 0));
    const Pose pb = touching_pose(random, a, pa, b, -gap);
    for (Vec3 axis : {Vec3(0, 0, 0), random.direction(), Vec3(-1e30, 0, 0)}) {
      const double g = separating_axis(a, pa, b, pb, axis);
      EXPECT_GT(g, 0) << k << " gap " << gap;
      EXPECT_NEAR(axis.norm(), 1, 1e-15);
      EXPECT_NEAR(support_gap(a, pa, b, pb, axis), g, 1e-15);
      Vec3 again = axis;
      EXPECT_NEAR(separating_axis(a, pa, b, pb, again), g, 1e-15);
      EXPECT_LT((again - axis).norm(), 1e-15);
      EXPECT_EQ(evaluate(a, pa, b, pb, axis).volume, 0);
    }
  }
}

TEST(SeparatingAxis, OverlapGivesANegativeGapAndAGoodAxis) {
  Random random(2);
  for (int k = 0; k < 500; ++k) {
    ShapeTable table;
    table.add(as_is(random_hull(random, 5 + k % 20)));
    table.add(as_is(random_hull(random, 5 + k % 17)));
    const ConvexView a = table.view(0), b = table.view(1);
    const Pose pa{random_rotation(random), random.direction()};
    const double share = std::pow(10, random.uniform(-7, -1));
    const Pose pb = touching_pose(random, a, pa, b, share);
    Vec3 axis = Vec3::Zero();
    const double g = separating_axis(a, pa, b, pb, axis);
    EXPECT_LT(g, 0);
    EXPECT_GT(g, -2 * share);  // no deeper than the push that made the overlap
    EXPECT_NEAR(axis.norm(), 1, 1e-15);
    EXPECT_TRUE(evaluate(a, pa, b, pb, axis).touching);
  }
}

TEST(SeparatingAxis, BodiesAtTheSamePlace) {
  ShapeTable table;
  table.add(as_is(make_box(Vec3(1, 1, 1))));
  const ConvexView cube = table.view(0);
  const Pose pose{Mat3::Identity(), Vec3::Zero()};
  Vec3 axis = Vec3::Zero();
  EXPECT_DOUBLE_EQ(separating_axis(cube, pose, cube, pose, axis), -1);
  EXPECT_NEAR(axis.norm(), 1, 1e-15);
}

TEST(ContactFrame, IsARotationAndSnapsToFaces) {
  Random random(3);
  ShapeTable table;
  table.add(as_is(make_box(Vec3(1, 1, 1))));
  const ConvexView cube = table.view(0);
  for (int k = 0; k < 200; ++k) {
    const Pose pa{random_rotation(random), random.direction()},
        pb{random_rotation(random), random.direction()};
    const Vec3 n = k == 0 ? Vec3(0, 0, -1) : random.direction();
    const ContactFrame f = contact_frame(cube, pa, cube, pb, 1e-20 * n);
    EXPECT_LT((f.axes.transpose() * f.axes - Mat3::Identity()).norm(), 1e-14);
    EXPECT_NEAR(f.axes.determinant(), 1, 1e-14);
    EXPECT_GT(f.axes.col(2).dot(n), 0.989);
  }
  const Pose at{Mat3::Identity(), Vec3::Zero()}, above{Mat3::Identity(), Vec3(0, 0, 0.999)};
  const ContactFrame f = contact_frame(cube, at, cube, above, Vec3(.05, .05, 1));
  EXPECT_EQ(f.axes.col(2), Vec3(0, 0, 1));
  EXPECT_NEAR(f.origin.z(), 0.4995, 1e-15);
}

}  // namespace
}  // namespace trackbed::dem::test
