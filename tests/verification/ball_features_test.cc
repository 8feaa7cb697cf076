// The deepest balls from the features of the last step: right when they say so, whatever features
// they are given, by the conditions of the optimum over all corners.
#include "dem/contact/ball_features.h"

#include <gtest/gtest.h>

#include <vector>

#include "contact_support.h"
#include "dem/grain/parts.h"

namespace trackbed::dem {
namespace {

using test::random_hull;
using test::random_rotation;
using test::rotation;

GrainShape dilated(const Polyhedron& core, double r, double crown) {
  return as_grain(make_dilated_shape({core, r}), crown);
}

Vec3 normal_of(const ConvexView& v, int f) { return {v.nx[f], v.ny[f], v.nz[f]}; }

struct PairOfCores {
  ShapeTable table;
  Mat3 Ra, Rb;
  Vec3 apart;

  PairOfCores(Random& random, double crown) {
    const bool box = random.below(3) == 0;
    table.add(dilated(box ? make_box({1, .8, .6}) : random_hull(random, 14), .1, crown));
    table.add(dilated(random_hull(random, 12), .2, random.below(2) ? crown : .05));
  }
  const PartView& a() const { return table.part(0, 0); }
  const PartView& b() const { return table.part(1, 0); }
  Pose pose() const { return {Rb, apart}; }

  // Any way round; or face to face but for a tilt that the crown lets roll; or an edge of b on a
  // face of a.
  void place(Random& random, int kind) {
    Ra = random_rotation(random), Rb = random_rotation(random);
    Vec3 way = random.direction();
    if (kind > 0) {
      way = Ra * normal_of(a().core, static_cast<int>(random.below(a().core.faces)));
      const ConvexView& v = b().core;
      Vec3 down = normal_of(v, static_cast<int>(random.below(v.faces)));
      if (kind > 1) {  // between the normals at an edge
        const Star star(v, static_cast<int>(random.below(v.vertices)));
        down = (normal_of(v, star.left_face(0)) + normal_of(v, star.right_face(0))).normalized();
      }
      Rb = rotation(random.uniform(0, .02) * random.direction()) *
           Quat::FromTwoVectors(down, -way).normalized().toRotationMatrix();
    }
    apart = random.uniform(2.05, 2.4) * way;
    if (kind > 0) apart += random.uniform(0, .3) * random.direction();
  }
};

// x, y optimal: no corner lies downhill of them, and they lie on their features.
void expect_optimum(const PairOfCores& p, const DeepestBalls& d) {
  const Vec3 x = p.Ra.transpose() * d.x, y = p.Rb.transpose() * (d.y - p.apart);
  const ConvexView &u = p.a().core, &v = p.b().core;
  const Vec3 gx = p.a().crown * x - p.Ra.transpose() * d.n,
             gy = p.b().crown * y + p.Rb.transpose() * d.n;
  for (int i = 0; i < u.vertices; ++i) EXPECT_GT(gx.dot(Vec3(u.x[i], u.y[i], u.z[i]) - x), -1e-11);
  for (int i = 0; i < v.vertices; ++i) EXPECT_GT(gy.dot(Vec3(v.x[i], v.y[i], v.z[i]) - y), -1e-11);
  for (int f = 0; f < u.faces; ++f) EXPECT_LT(normal_of(u, f).dot(x) - u.offset[f], 1e-12);
  for (int f = 0; f < v.faces; ++f) EXPECT_LT(normal_of(v, f).dot(y) - v.offset[f], 1e-12);
  EXPECT_NEAR((d.y - d.x - (d.y - d.x).norm() * d.n).norm(), 0, 1e-13);
  const auto radius = [](const PartView& part, const Vec3& at) {
    return part.radius + part.crown / 2 * (part.mean_square - at.squaredNorm());
  };
  EXPECT_NEAR(d.ra, radius(p.a(), x), 1e-14);
  EXPECT_NEAR(d.rb, radius(p.b(), y), 1e-14);
  EXPECT_NEAR(d.overlap, d.ra + d.rb - (d.y - d.x).norm(), 1e-13);
}

TEST(BallFeatures, of_the_last_step_give_the_optimum) {
  Random random(8);
  int found[3][3] = {}, searched[3][3] = {};
  std::vector<PairOfCores> pairs;
  for (int k = 0; k < 60; ++k) pairs.emplace_back(random, k % 2 ? .02 : .2);
  for (int k = 0; k < 1500; ++k) {
    PairOfCores& p = pairs[k % 60];
    p.place(random, k % 3);
    Vec3 axis = Vec3::Zero();
    const DeepestBalls last = deepest_balls(p.a(), p.Ra, p.b(), p.pose(), Vec3::Zero(), axis);
    if (!last.on_a || !last.on_b) continue;
    const CoreFeature on_a = CoreFeature::of(last.on_a), on_b = CoreFeature::of(last.on_b);
    for (const double moved : {0., 1e-7, 1e-3}) {
      p.apart += moved * random.direction();
      p.Rb = rotation(moved * random.direction()) * p.Rb;
      DeepestBalls d;
      ++searched[on_a.dimension][on_b.dimension];
      if (!deepest_balls_again(p.a(), p.Ra, p.b(), p.pose(), on_a, on_b, d)) continue;
      ++found[on_a.dimension][on_b.dimension];
      expect_optimum(p, d);
      const DeepestBalls other = deepest_balls(p.a(), p.Ra, p.b(), p.pose(), last.x, axis);
      EXPECT_NEAR(other.overlap, d.overlap, 1e-12);
      EXPECT_LT((other.n - d.n).norm(), 1e-9);
    }
  }
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      EXPECT_GT(searched[i][j], 30) << i << j;
      EXPECT_GT(found[i][j], .8 * searched[i][j]) << i << j;
    }
}

TEST(BallFeatures, are_not_believed) {
  // Any features at all: an optimum or nothing.
  Random random(9);
  long accepted = 0;
  const auto any = [&](const ConvexView& v) {
    CoreFeature f;
    f.dimension = static_cast<int>(random.below(3));
    f.index = static_cast<int>(random.below(f.dimension == 2 ? v.faces : v.vertices));
    const int edges = f.dimension == 1 ? Star(v, f.index).edges() : 0;
    if (edges > 0) f.edge = static_cast<int>(random.below(edges));
    return f;
  };
  for (int k = 0; k < 40; ++k) {
    PairOfCores p(random, .02);
    for (int n = 0; n < 6000; ++n) {
      if (n % 400 == 0) p.place(random, n / 400 % 3);
      DeepestBalls d;
      if (!deepest_balls_again(p.a(), p.Ra, p.b(), p.pose(), any(p.a().core), any(p.b().core), d))
        continue;
      ++accepted;
      expect_optimum(p, d);
    }
  }
  EXPECT_GT(accepted, 50);
}

TEST(BallFeatures, survive_their_code) {
  for (const CoreFeature& f : {CoreFeature{0, 65535, 0}, CoreFeature{1, 1234, 6},
                               CoreFeature{2, 65534, 0}, CoreFeature{0, 0, 0}, CoreFeature{}}) {
    const CoreFeature same = CoreFeature::of(f.code());
    EXPECT_EQ(same.dimension, f.dimension);
    EXPECT_EQ(same.index, f.index);
    EXPECT_EQ(same.edge, f.edge);
  }
  EXPECT_EQ(CoreFeature{}.code(), 0);
}

}  // namespace
}  // namespace trackbed::dem
