// An overlap found again from what it was made of equals the one found from nothing.
#include <gtest/gtest.h>

#include "dem/contact/simple_contact.h"
#include "tests/verification/contact_support.h"

namespace trackbed::dem::test {
namespace {

struct Result {
  bool found = false;
  OverlapMoments m;
  Vec3 area = Vec3::Zero();
  Vec3 force = Vec3::Zero(), moment = Vec3::Zero();  // of the stored-energy law, world axes
};

// About the frame's origin, the same for both ways.
void about_origin(OverlapMoments& m) {
  const Vec3 c = m.about;
  m.second += m.first * c.transpose() + c * m.first.transpose() + m.volume * c * c.transpose();
  m.first += m.volume * c;
}

Result result(bool found, const OverlapMoments& m, const OverlapWorkspace& work,
              const ContactFrame& frame) {
  Result r;
  r.found = found, r.m = m;
  for (const OverlapPiece& piece : work.a_pieces) r.area += frame.axes * piece.area;
  if (!found) return r;
  const OverlapShape shape = make_shape(m, work);
  const PressureForce f =
      integrate_pressure(work, work.a_pieces, shape, StoredEnergyLaw()(shape, material(1)));
  r.force = -(frame.axes * f.force), r.moment = -(frame.axes * f.moment);
  about_origin(r.m);
  return r;
}

// A contact in closed form, in the axes of `frame`.
Result result(const SimpleContact& s, const ContactFrame& frame) {
  Result r;
  r.found = true;
  const Mat3 turn = frame.axes.transpose() * s.frame.axes;
  r.m.volume = s.shape.volume;
  r.m.about = turn * s.shape.centroid + frame.axes.transpose() * (s.frame.origin - frame.origin);
  r.m.second = turn * s.shape.second_moment * turn.transpose();
  r.area = s.frame.axes * s.shape.area;
  const PressureForce f =
      integrate_pressure(s.corner, s.corners, s.shape, StoredEnergyLaw()(s.shape, material(1)));
  const double sense = s.of_a ? -1 : 1;
  r.force = sense * (s.frame.axes * f.force), r.moment = sense * (s.frame.axes * f.moment);
  about_origin(r.m);
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
    Result again;
    SimpleContact simple;
    if (!feature.code)
      again =
          result(overlap_again(a, pa, b, pb, frame, feature, work, moments), moments, work, frame);
    else if (simple_contact(a, pa, b, pb, SimpleFeature::of(feature.code), simple))
      again = result(simple, frame);
    if (!again.found) {
      ++tally.other;
      EXPECT_TRUE(work.points.empty());
      continue;
    }
    ++tally.again;
    work.clear(), moments = {};
    const bool first = overlap(a, pa, b, pb, frame, work, moments);
    const Result anew = result(first, moments, work, frame);
    const double size = anew.area.norm(), length = std::sqrt(size), v = anew.m.volume;
    const bool same = first && std::abs(again.m.volume - v) < 1e-9 * v &&
                      (again.m.first - anew.m.first).norm() < 1e-9 * v &&
                      (again.m.second - anew.m.second).norm() < 1e-9 * v &&
                      (again.area - anew.area).norm() < 1e-9 * (size + length * a.radius) &&
                      (again.force - anew.force).norm() < 1e-8 * anew.force.norm() &&
                      (again.moment - anew.moment).norm() < 1e-8 * length * anew.force.norm();
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
