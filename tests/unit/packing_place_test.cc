// Placement: nothing overlaps, by an independent test of every pair; what must stay free stays
// free.
#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "dem/contact/overlap.h"
#include "dem/grain/library.h"
#include "dem/packing/lower.h"
#include "dem/packing/place.h"
#include "dem/surface/rigid.h"

namespace trackbed::dem {
namespace {

std::vector<GrainShape> stones(int count) {
  LibraryParameters p;
  p.count = count;
  p.method = SieveMethod::equal_cube;
  std::vector<GrainShape> shapes = make_library(p);
  for (std::size_t i = 0; i < shapes.size(); ++i)
    shapes[i] = scaled(shapes[i], 0.03 + 0.0005 * static_cast<double>(i % 40));
  return shapes;
}

struct Heap {
  ShapeTable shapes;
  Bodies bodies;
};

Heap heap(const PlacementSpace& space, bool lowered) {
  const std::vector<GrainShape> grains = stones(120);
  std::vector<double> radii;
  for (const GrainShape& g : grains) radii.push_back(g.radius);
  const Placement p = place_loose(radii, space, {}, 10, 5);
  Heap h;
  for (std::size_t i = 0; i < grains.size(); ++i)
    add_grain(h.bodies, h.shapes, h.shapes.add(grains[i]), 0, 2600, p.centre[i], p.turn[i]);
  if (lowered) lower_grains(h.bodies, h.shapes, 0, space.low.z(), space.period, 1e-5);
  return h;
}

// Support gap of a pair in all directions of a fine set: positive somewhere proves it apart.
bool apart(const Heap& h, int i, int j, const Vec3& period) {
  Vec3 shift = Vec3::Zero();
  for (int k = 0; k < 2; ++k)
    if (period[k] > 0)
      shift[k] = -period[k] * std::round((h.bodies.x[j][k] - h.bodies.x[i][k]) / period[k]);
  Vec3 axis = h.bodies.x[j] + shift - h.bodies.x[i];
  return separating_axis(h.shapes.view(h.bodies.shape[i]), {h.bodies.R[i], h.bodies.x[i]},
                         h.shapes.view(h.bodies.shape[j]), {h.bodies.R[j], h.bodies.x[j] + shift},
                         axis) > 0;
}

int overlaps(const Heap& h, const Vec3& period) {
  int count = 0;
  for (int i = 0; i < h.bodies.size(); ++i)
    for (int j = i + 1; j < h.bodies.size(); ++j) count += !apart(h, i, j, period);
  return count;
}

double lowest(const Heap& h, int i) {
  double low = HUGE_VAL;
  for (const Vec3& p : h.shapes.shape(h.bodies.shape[i]).body.vertices)
    low = std::min(low, h.bodies.x[i].z() + (h.bodies.R[i] * p).z());
  return low;
}

double mean_height(const Heap& h) {
  double sum = 0;
  for (const Vec3& x : h.bodies.x) sum += x.z();
  return sum / h.bodies.size();
}

PlacementSpace box(double period_y) {
  PlacementSpace space;
  space.low = {-0.15, -0.1, 0}, space.high = {0.15, 0.1, 0};
  space.period.y() = period_y;
  return space;
}

TEST(Place, nothing_overlaps_between_walls_and_across_a_seam) {
  for (const double period : {0.0, 0.2}) {
    const PlacementSpace space = box(period);
    EXPECT_EQ(overlaps(heap(space, false), space.period), 0);
  }
}

TEST(Lower, nothing_overlaps_and_every_grain_comes_to_the_floor_or_another) {
  for (const double period : {0.0, 0.2}) {
    const PlacementSpace space = box(period);
    const Heap before = heap(space, false), after = heap(space, true);
    EXPECT_EQ(overlaps(after, space.period), 0);
    EXPECT_LT(mean_height(after), 0.9 * mean_height(before));
    // A hair lower each of them would meet something.
    for (int i = 0; i < after.bodies.size(); ++i) {
      Heap moved = after;
      moved.bodies.x[i].z() -= 5e-5;
      bool stopped = lowest(moved, i) < 0;
      for (int j = 0; j < moved.bodies.size() && !stopped; ++j)
        if (j != i) stopped = !apart(moved, i, j, space.period);
      EXPECT_TRUE(stopped) << "grain " << i;
      EXPECT_GE(lowest(after, i), 0);
    }
  }
}

TEST(Place, blocks_stay_free_and_walls_are_kept) {
  PlacementSpace space = box(0);
  space.low.x() = -0.3, space.high.x() = 0.3;
  space.blocks.push_back({{-0.1, -0.1, 0}, {0.1, 0.1, 0}});
  const Heap h = heap(space, true);
  for (int i = 0; i < h.bodies.size(); ++i)
    for (const Vec3& p : h.shapes.shape(h.bodies.shape[i]).body.vertices) {
      const Vec3 x = h.bodies.x[i] + h.bodies.R[i] * p;
      EXPECT_GT(std::abs(x.x()), 0.1);
      EXPECT_LT(std::abs(x.x()), 0.3);
      EXPECT_LT(std::abs(x.y()), 0.1);
    }
}

// Mirror image of the walls' case: with a seam grains do stand across it, between walls none does.
TEST(Place, grains_stand_across_the_seam_but_not_through_walls) {
  for (const double period : {0.0, 0.2}) {
    const Heap h = heap(box(period), false);
    int across = 0;
    for (int i = 0; i < h.bodies.size(); ++i) {
      bool out = false;
      for (const Vec3& p : h.shapes.shape(h.bodies.shape[i]).body.vertices)
        out = out || std::abs((h.bodies.x[i] + h.bodies.R[i] * p).y()) > 0.1;
      across += out;
    }
    if (period == 0)
      EXPECT_EQ(across, 0);
    else
      EXPECT_GT(across, 5);
  }
}

TEST(Place, grains_keep_to_their_zone) {
  PlacementSpace space = box(0);
  space.zones = {{{-0.05, -0.1, 0}, {0.05, 0.1, 0}}, {{-0.08, -0.1, 0}, {0.08, 0.1, 0}}};
  std::vector<double> radii;
  std::vector<int> zone;
  for (int i = 0; i < 150; ++i) radii.push_back(0.012 + 1e-5 * i), zone.push_back(i % 3);
  const Placement p = place_loose(radii, space, {}, 10, 5, zone);
  for (int i = 0; i < 150; ++i) {
    const double x = std::abs(p.centre[i].x());
    EXPECT_EQ(x <= 0.05 ? 0 : x <= 0.08 ? 1 : 2, zone[i]);
    for (int j = 0; j < i; ++j)
      EXPECT_GT((p.centre[i] - p.centre[j]).norm(), radii[i] + radii[j] - 1e-12);
  }
  space.zones[0].low.x() = space.zones[0].high.x() = 1;
  EXPECT_THROW(place_loose(radii, space, {}, 10, 5, zone), InputError);
}

TEST(Place, a_round_container_holds_every_grain) {
  PlacementSpace space;
  space.low = {-0.15, -0.15, 0}, space.high = {0.15, 0.15, 0};
  space.radius = 0.15;
  const std::vector<double> radii(100, 0.02);
  double furthest = 0;
  for (const Vec3& x : place_loose(radii, space, {}, 10, 5).centre)
    furthest = std::max(furthest, x.head<2>().norm() + 0.02);
  EXPECT_LE(furthest, 0.15);
  EXPECT_GT(furthest, 0.13);
}

TEST(RoundWall, the_prism_has_the_circles_area_and_stays_near_it) {
  const double r = 0.15;
  for (const int sides : {8, 32, 64}) {
    const Polyhedron prism = make_round_prism(r, 0.4, sides);
    EXPECT_NEAR(mass_properties(prism).volume, M_PI * r * r * 0.4, 1e-14);
    const double n2 = sides * sides, pi2 = M_PI * M_PI;
    double corner = 0;
    for (const Vec3& p : prism.vertices) corner = std::max(corner, p.head<2>().norm());
    EXPECT_NEAR(corner / r - 1, pi2 / (3 * n2), 60 / (n2 * n2));
    EXPECT_NEAR(1 - prism_apothem(r, sides) / r, pi2 / (6 * n2), 60 / (n2 * n2));
  }
}

// Along any ray from the axis the wall begins where the prism's side is, without a gap.
TEST(RoundWall, is_closed_and_as_far_from_the_axis_as_the_prism) {
  const double r = 0.15;
  const int sides = 16;
  Bodies bodies;
  ShapeTable shapes;
  add_round_wall(bodies, shapes, {0.3, -0.2, 0}, r, -0.1, 0.5, 0.05, 0, sides);
  ASSERT_EQ(bodies.size(), sides);
  const auto in_wall = [&](const Vec3& p) {
    for (int i = 0; i < bodies.size(); ++i) {
      const ConvexView& v = shapes.view(bodies.shape[i]);
      const Vec3 x = bodies.R[i].transpose() * (p - bodies.x[i]);
      bool inside = true;
      for (int f = 0; f < v.faces && inside; ++f)
        inside = v.nx[f] * x.x() + v.ny[f] * x.y() + v.nz[f] * x.z() <= v.offset[f] + 1e-12;
      if (inside) return true;
    }
    return false;
  };
  const double apothem = prism_apothem(r, sides);
  for (int k = 0; k < 1000; ++k) {
    const double angle = 2 * M_PI * k / 1000, pitch = 2 * M_PI / sides;
    const double side = apothem / std::cos(angle - pitch * std::round(angle / pitch));
    const Vec3 ray(std::cos(angle), std::sin(angle), 0), axis(0.3, -0.2, 0.2);
    EXPECT_FALSE(in_wall(axis + (side - 1e-9) * ray)) << angle;
    EXPECT_TRUE(in_wall(axis + (side + 1e-9) * ray)) << angle;
    EXPECT_TRUE(in_wall(axis + (side + 0.04) * ray)) << angle;
  }
}

TEST(Place, same_seed_same_places) {
  const Heap a = heap(box(0), true), b = heap(box(0), true);
  for (int i = 0; i < a.bodies.size(); ++i) EXPECT_EQ(a.bodies.x[i], b.bodies.x[i]);
}

TEST(Place, a_grain_wider_than_the_space_is_refused) {
  EXPECT_THROW(place_loose({0.11}, box(0), {}, 10, 1), InputError);
}

}  // namespace
}  // namespace trackbed::dem
