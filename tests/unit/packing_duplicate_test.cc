// Duplicated samples: a lattice stays one, mirror images are solids, seams close.
#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "dem/grain/library.h"
#include "dem/grain/parts.h"
#include "dem/grain/random.h"
#include "dem/motion/monitor.h"
#include "dem/packing/duplicate.h"
#include "dem/packing/place.h"
#include "packing_bed.h"

namespace trackbed::dem {
namespace {

// Cubes of edge a at distance a + gap, m in a row, standing on z = 0 in the box of their cells.
PackedGrains lattice(int m, double a, double gap) {
  PackedGrains g;
  const GrainShape cube = make_grain_shape(make_box({a, a, a}));
  for (int i = 0; i < m * m * m; ++i)
    g.add(cube, (a + gap) * Vec3(i % m + .5, i / m % m + .5, i / (m * m)) + Vec3(0, 0, .5 * a),
          cube.turn);
  return g;
}

PackedGrains layered(const PackedGrains& sample, const LayerSettings& s) {
  const LayeredBed result = duplicate_layers(sample, s);
  EXPECT_TRUE(result.left_out.empty());
  return result.bed;
}

std::vector<GrainShape> stones(int count) {
  LibraryParameters p;
  p.count = count;
  p.method = SieveMethod::equal_cube;
  std::vector<GrainShape> shapes = make_library(p);
  for (auto& g : shapes) g = scaled(g, 0.025);
  return shapes;
}

PackedGrains loose_sample(const LayerSettings& s, int count) {
  PackedGrains g;
  std::vector<double> radii;
  const auto shapes = stones(count);
  for (const auto& shape : shapes) radii.push_back(shape.radius);
  PlacementSpace space;
  space.low = s.low, space.high = s.high, space.period = s.period;
  const Placement placed = place_loose(radii, space, {}, 20, 3);
  for (int i = 0; i < count; ++i) g.add(shapes[i], placed.centre[i], placed.turn[i]);
  return g;
}

// Least separation of two grains, over their images: positive = apart.
double gap(const PackedGrains& g, int i, int j, const Vec3& period) {
  ShapeTable table;
  table.add(g.shape[i]), table.add(g.shape[j]);
  const Vec3 shift = nearest_image(g.centre[i], g.centre[j], period);
  Vec3 axis = g.centre[j] + shift - g.centre[i];
  return separating_axis(table.view(0), {g.turn[i].toRotationMatrix(), g.centre[i]}, table.view(1),
                         {g.turn[j].toRotationMatrix(), g.centre[j] + shift}, axis);
}

TEST(Duplicate, a_lattice_stays_a_lattice) {
  const double a = .05, pitch = .06;
  const PackedGrains sample = lattice(3, a, pitch - a);
  LayerSettings s;
  s.layers = 3;
  s.low = {0, 0, 0}, s.high = {3 * pitch, 3 * pitch, 0};
  s.spacing = 3 * pitch;
  const PackedGrains bed = layered(sample, s);
  ASSERT_EQ(bed.size(), 81);
  // Every site of the 3 x 3 x 9 lattice is taken once, whatever the layers' turns and mirrors.
  std::vector<int> taken(81, 0);
  for (int i = 0; i < bed.size(); ++i) {
    const Vec3 site = (bed.centre[i] - Vec3(0, 0, .5 * a)) / pitch - Vec3(.5, .5, 0);
    const Vec3 whole = site.array().round();
    EXPECT_LT((site - whole).norm(), 1e-12);
    ++taken.at(static_cast<int>(whole.x() + 3 * whole.y() + 9 * whole.z()));
    for (const Vec3& p : bed.shape[i].body.vertices)
      EXPECT_NEAR((bed.turn[i] * p).cwiseAbs().maxCoeff(), .5 * a, 1e-12);
  }
  for (const int n : taken) EXPECT_EQ(n, 1);
}

TEST(Duplicate, the_mirror_image_of_a_clump_holds_the_spheres_images) {
  PackedGrains g;
  g.add(as_grain(make_clump_shape(
            {{{0, 0, 0}, .02}, {{.02, 0, 0}, .012}, {{0, .025, 0}, .01}, {{0, 0, .03}, .015}})),
        {.1, .2, .3}, Quat(.3, -.5, .2, .7).normalized());
  const PackedGrains before = g;
  for (int axis = 0; axis < 3; ++axis) {
    g = before;
    mirror(g, 0, axis, .05);
    for (std::size_t k = 0; k < g.shape[0].parts.size(); ++k) {
      const auto place = [&](const PackedGrains& p) -> Vec3 {
        return p.centre[0] + p.turn[0] * p.shape[0].parts[k].core.vertices[0];
      };
      Vec3 image = place(before);
      image[axis] = .1 - image[axis];
      EXPECT_LT((place(g) - image).norm(), 1e-15);
    }
  }
}

TEST(Duplicate, a_layer_let_down_stops_at_the_clearance_above_the_one_below) {
  const double a = .05, clearance = 1e-3;
  LayerSettings s;
  s.layers = 3;
  s.low = {0, 0, 0}, s.high = {.18, .18, 0};
  s.clearance = clearance;
  const PackedGrains bed = layered(lattice(3, a, .01), s);
  // Flat on flat: the layers are two pitches and a cube high.
  const double layer = 2 * .06 + a + clearance;
  for (int i = 0; i < bed.size(); ++i) {
    const int k = i / 27;
    const double z = bed.centre[i].z() - .5 * a - k * layer;
    EXPECT_NEAR(z, .06 * std::round(z / .06), 1e-8);
  }
}

TEST(Duplicate, loose_stones_do_not_overlap_and_the_block_touches) {
  for (const double period : {0., .12}) {
    LayerSettings s;
    s.layers = 4;
    s.low = {-.05, -.06, 0}, s.high = {.05, .06, 0};
    s.period.y() = period;
    const PackedGrains sample = loose_sample(s, 40);
    const PackedGrains bed = layered(sample, s);
    ASSERT_EQ(bed.size(), 160);
    for (int k = 1; k < 4; ++k) {
      double least = 1;
      for (int i = 40 * k; i < 40 * k + 40; ++i)
        for (int j = 0; j < i; ++j)
          if ((bed.centre[i] - bed.centre[j] -
               nearest_image(bed.centre[i], bed.centre[j], s.period))
                  .norm() < .08) {
            const double g = gap(bed, i, j, s.period);
            EXPECT_GT(g, 0) << i << " and " << j;
            if (j < 40 * k) least = std::min(least, g);
          }
      EXPECT_LT(least, 1.1e-4) << "layer " << k << " hangs in the air";
    }
    for (const Vec3& x : bed.centre) {
      EXPECT_TRUE(x.x() >= s.low.x() && x.x() <= s.high.x());
      EXPECT_TRUE(x.y() >= s.low.y() - 1e-12 && x.y() <= s.high.y() + 1e-12);
    }
  }
}

// How far the nearest grain of the layer below is from where a plain copy has it.
TEST(Duplicate, layers_are_not_copies_of_each_other) {
  LayerSettings s;
  s.layers = 8;
  s.low = {-.05, -.05, 0}, s.high = {.05, .05, 0};
  const PackedGrains bed = layered(loose_sample(s, 40), s);
  for (int one = 0; one < 8; ++one)
    for (int other = 0; other < one; ++other) {
      double mean = 0;
      for (int i = 0; i < 40; ++i)
        mean += (bed.centre[40 * one + i] - bed.centre[40 * other + i]).head<2>().norm() / 40;
      EXPECT_GT(mean, .01) << "layers " << other << " and " << one;
    }
  s.varied = false;
  const PackedGrains plain = layered(loose_sample(s, 40), s);
  for (int i = 40; i < plain.size(); ++i) {
    EXPECT_EQ(plain.centre[i].x(), plain.centre[i - 40].x());
    EXPECT_EQ(plain.centre[i].y(), plain.centre[i - 40].y());
  }
}

TEST(Duplicate, a_mirror_image_is_a_solid_where_the_mirror_puts_it) {
  PackedGrains g;
  Random random(3);
  for (const GrainShape& shape : stones(20))
    g.add(shape, random.direction(),
          Quat(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1),
               random.uniform(-1, 1))
              .normalized());
  for (int axis = 0; axis < 3; ++axis)
    for (int i = 0; i < g.size(); ++i) {
      PackedGrains image = g;
      mirror(image, i, axis, .3);
      for (std::size_t v = 0; v < g.shape[i].body.vertices.size(); ++v) {
        Vec3 p = g.centre[i] + g.turn[i] * g.shape[i].body.vertices[v];
        p[axis] = .6 - p[axis];
        EXPECT_LT((image.centre[i] + image.turn[i] * image.shape[i].body.vertices[v] - p).norm(),
                  1e-14);
      }
      const MassProperties m = mass_properties(image.shape[i].body);  // throws when inside-out
      EXPECT_NEAR(m.volume, g.shape[i].volume, 1e-12 * m.volume);
      EXPECT_LT(m.centroid.norm(), 1e-12);
      EXPECT_NEAR((m.inertia.diagonal() - g.shape[i].inertia).norm() / m.inertia.norm(), 0, 1e-9);
    }
}

TEST(Duplicate, a_periodic_row_has_the_samples_own_neighbours) {
  LayerSettings s;
  s.low = {-.05, -.06, 0}, s.high = {.05, .06, 0};
  s.period.y() = .12;
  const PackedGrains sample = loose_sample(s, 30);
  const PackedGrains row = duplicate_along(sample, 1, .12, 3);
  ASSERT_EQ(row.size(), 90);
  const Vec3 period(0, .36, 0);
  for (int i = 0; i < 30; ++i)
    for (int j = 0; j < i; ++j) {
      const Vec3 shift = nearest_image(sample.centre[i], sample.centre[j], s.period);
      if ((sample.centre[i] - sample.centre[j] - shift).norm() > .08) continue;
      const double here = gap(sample, i, j, s.period);
      // In the row the partner is in the same copy or in one beside it.
      const int copy = (3 + static_cast<int>(std::lround(shift.y() / .12))) % 3;
      EXPECT_NEAR(gap(row, i, j + 30 * copy, period), here, 1e-12);
    }
}

// Porosity between two heights by random points: no use of the measures of the library.
double sampled_porosity(const Scene& s, double low, double high) {
  Random random(1);
  int hits = 0;
  const int points = 20000;
  for (int n = 0; n < points; ++n) {
    const Vec3 p(random.uniform(0, .1), random.uniform(0, .1), random.uniform(low, high));
    for (int i = 0; i < s.bodies.grains; ++i) {
      const ConvexView& v = s.shapes.view(s.bodies.shape[i]);
      const Vec3 x = s.bodies.R[i].transpose() * (p - s.bodies.x[i]);
      if (x.squaredNorm() > v.radius * v.radius) continue;
      bool inside = true;
      for (int f = 0; f < v.faces && inside; ++f)
        inside = v.nx[f] * x.x() + v.ny[f] * x.y() + v.nz[f] * x.z() <= v.offset[f];
      if (inside) {
        ++hits;
        break;
      }
    }
  }
  return 1 - double(hits) / points;
}

// The seam of two layers: a slice of one grain's height about it, against the bulk of the lower.
TEST(Duplicate, a_seam_loses_its_pores_as_it_settles) {
  const double d = .025;
  for (const double mu : {0.2, 0.5}) {
    double before = 0, after = 0;  // more pores than the bulk, mean of beds of forty grains
    const int beds = 4;
    for (int seed = 1; seed <= beds; ++seed) {
      const RealBed one(mu, seed);
      LayerSettings s;
      s.low = {0, 0, 0}, s.high = {.1, .1, 0};
      s.sink = .5 * d;
      const LayeredBed two = duplicate_layers(packed_grains(one.scene.bodies, one.scene.shapes), s);
      EXPECT_GT(two.left_out.size(), 0u);
      EXPECT_LE(two.left_out.size(), 8u);  // a fifth of the layer
      EXPECT_EQ(two.bed.size() + two.left_out.size(), 80u);
      for (int i = 40; i < two.bed.size(); ++i)
        for (int j = 0; j < 40; ++j)
          EXPECT_TRUE(two.layer[i] == 1 && gap(two.bed, i, j, Vec3::Zero()) > 0);
      RealBed bed(two.bed);
      const auto excess = [&] {
        double low = 1;  // of the copy
        for (int i = 40; i < bed.scene.bodies.grains; ++i)
          for (const Vec3& p : bed.scene.shapes.shape(bed.scene.bodies.shape[i]).body.vertices)
            low = std::min(low, (bed.scene.bodies.x[i] + bed.scene.bodies.R[i] * p).z());
        const double z = low + .5 * s.sink;
        return sampled_porosity(bed.scene, z - .5 * d, z + .5 * d) -
               sampled_porosity(bed.scene, d, z - d);
      };
      before += excess() / beds;
      bed.settle(mu);
      after += excess() / beds;
      EXPECT_LT(deepest_overlap(bed.scene.bodies, bed.scene.shapes, bed.scene.pairs).share, 0.1);
    }
    EXPECT_GT(before, 0.15) << "rough meets flat";
    // One bed scatters by 0.04.
    EXPECT_LT(std::abs(after), before / 3);
  }
}

TEST(Duplicate, bad_settings_are_refused) {
  LayerSettings s;
  s.low = {0, 0, 0}, s.high = {1, 1, 0};
  EXPECT_THROW(duplicate_layers({}, s), InputError);
  s.layers = 0;
  EXPECT_THROW(duplicate_layers(lattice(2, .1, .1), s), InputError);
  EXPECT_THROW(duplicate_along(lattice(2, .1, .1), 2, 1, 2), InputError);
  EXPECT_THROW(duplicate_along(lattice(2, .1, .1), 1, 0, 2), InputError);
}

}  // namespace
}  // namespace trackbed::dem
