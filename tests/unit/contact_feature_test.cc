// An overlap found again from what it was made of equals the one found from nothing.
#include <gtest/gtest.h>

#include "dem/contact/overlap_feature.h"
#include "tests/verification/contact_support.h"

namespace trackbed::dem::test {
namespace {

struct Result {
  bool found = false;
  OverlapMoments m;
  Vec3 area = Vec3::Zero();
};

Result result(bool found, const OverlapMoments& m, const OverlapWorkspace& work,
              const ContactFrame& frame) {
  Result r{found, m, Vec3::Zero()};
  for (const OverlapPiece& piece : work.a_pieces) r.area += frame.axes * piece.area;
  if (!found) return r;
  // About the frame's origin, the same for both ways.
  const Vec3 c = m.about;
  r.m.second += m.first * c.transpose() + c * m.first.transpose() + m.volume * c * c.transpose();
  r.m.first += m.volume * c;
  return r;
}

struct Tally {
  int again = 0, other = 0, wrong = 0;
};

// Pairs that touch, then moved and turned by `share` of the overlap's depth.
void compare(const ShapeTable& table, Random& random, double share, int pairs, Tally& tally) {
  OverlapWorkspace work;
  for (int n = 0; n < pairs; ++n) {
    const ConvexView &a = table.view(int(random.below(table.size()))),
                     &b = table.view(int(random.below(table.size())));
    const bool aligned = n % 4 == 0;  // faces, edges and corners in line: degenerate
    const Mat3 turn = aligned ? Mat3::Identity() : random_rotation(random);
    const Pose pa{aligned ? Mat3::Identity() : random_rotation(random), random.direction()};
    const double depth = std::pow(10, random.uniform(-4, -1.5));
    Pose pb = touching_pose(random, a, pa, b, depth);
    if (aligned) pb.R = turn;
    Vec3 axis = Vec3::Zero();
    if (separating_axis(a, pa, b, pb, axis) > 0) continue;
    ContactFrame frame = contact_frame(a, pa, b, pb, axis);
    work.clear();
    OverlapMoments moments;
    if (!overlap(a, pa, b, pb, frame, work, moments) || !work.feature) continue;
    const OverlapFeature feature = work.feature;

    pb.x += share * depth * b.radius * random.direction();
    pb.R = rotation(share * depth * random.direction()) * pb.R;
    work.clear(), moments = {};
    const bool found = overlap_again(a, pa, b, pb, frame, feature, work, moments);
    if (!found) {
      ++tally.other;
      EXPECT_TRUE(work.points.empty());
      continue;
    }
    ++tally.again;
    const Result again = result(found, moments, work, frame);
    work.clear(), moments = {};
    const bool first = overlap(a, pa, b, pb, frame, work, moments);
    const Result anew = result(first, moments, work, frame);
    const double size = anew.area.norm(), length = std::sqrt(size), v = anew.m.volume;
    const bool same = first && std::abs(again.m.volume - v) < 1e-9 * v &&
                      (again.m.first - anew.m.first).norm() < 1e-9 * v &&
                      (again.m.second - anew.m.second).norm() < 1e-9 * v &&
                      (again.area - anew.area).norm() < 1e-9 * (size + length * a.radius);
    if (!same) {
      ++tally.wrong;
      ADD_FAILURE() << "pair " << n << ": V " << again.m.volume << " for " << v << ", feature "
                    << feature.code << ' ' << feature.faces_a << ' ' << feature.faces_b;
    }
  }
}

ShapeTable solids(Random& random) {
  ShapeTable table;
  for (int k = 0; k < 30; ++k) table.add(as_is(random_hull(random, 10 + k % 8)));
  for (int k = 0; k < 10; ++k)
    table.add(as_is(make_box(Vec3(random.uniform(.5, 1), random.uniform(.5, 1), 1))));
  table.add(as_is(make_box(Vec3::Ones())));
  return table;
}

TEST(Feature, SmallMovesKeepIt) {
  Random random(7);
  const ShapeTable table = solids(random);
  Tally tally;
  compare(table, random, 1e-3, 4000, tally);
  EXPECT_GT(tally.again, 30 * tally.other);
  EXPECT_GT(tally.again, 2000);
}

// A feature that lacks one of the faces is found out.
TEST(Feature, MissingFaceIsRefused) {
  Random random(9);
  const ShapeTable table = solids(random);
  OverlapWorkspace work;
  int tried = 0;
  for (int n = 0; n < 500; ++n) {
    const ConvexView &a = table.view(int(random.below(table.size()))),
                     &b = table.view(int(random.below(table.size())));
    const Pose pa{random_rotation(random), random.direction()};
    const Pose pb = touching_pose(random, a, pa, b, 0.3);
    Vec3 axis = Vec3::Zero();
    separating_axis(a, pa, b, pb, axis);
    const ContactFrame frame = contact_frame(a, pa, b, pb, axis);
    work.clear();
    OverlapMoments moments;
    if (!overlap(a, pa, b, pb, frame, work, moments) || !work.feature.faces_a) continue;
    const OverlapFeature whole = work.feature;
    for (int f = 0; f < 31; ++f)
      for (int OverlapFeature::*const faces :
           {&OverlapFeature::faces_a, &OverlapFeature::faces_b}) {
        OverlapFeature part = whole;
        part.*faces &= ~(1 << f);
        if (part.*faces == whole.*faces || !part) continue;
        OverlapWorkspace again;
        moments = {};
        EXPECT_FALSE(overlap_again(a, pa, b, pb, frame, part, again, moments)) << n;
        ++tried;
      }
  }
  EXPECT_GT(tried, 1000);
}

TEST(Feature, LargeMovesAreProvedOrRefused) {
  Random random(8);
  const ShapeTable table = solids(random);
  Tally tally;
  for (const double share : {0.1, 0.5, 2.0, 10.0}) compare(table, random, share, 2000, tally);
  EXPECT_GT(tally.again, 500);
  EXPECT_GT(tally.other, 500);
}

}  // namespace
}  // namespace trackbed::dem::test
