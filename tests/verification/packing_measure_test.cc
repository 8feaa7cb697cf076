// Volumes inside regions against closed forms and against the contact kernel's clipping, which
// computes the same number by another way; porosity and coordination of packings known by hand.
#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "dem/contact/overlap.h"
#include "dem/grain/dilated.h"
#include "dem/grain/library.h"
#include "dem/grain/parts.h"
#include "dem/grain/random.h"
#include "dem/packing/measure.h"
#include "dem/packing/section.h"
#include "dem/surface/rigid.h"
#include "motion_scene.h"

namespace trackbed::dem {
namespace {

std::vector<GrainShape> stones(int count) {
  LibraryParameters p;
  p.count = count, p.method = SieveMethod::equal_cube;
  return make_library(p);
}

PlacedGrain of_bodies(std::vector<Polyhedron> bodies) {
  PlacedGrain g;
  g.outline = std::make_shared<GrainOutline>(GrainOutline{std::move(bodies), {}});
  return g;
}

double area(const std::vector<Vec2>& p) {
  double twice = 0;
  for (size_t k = 0; k < p.size(); ++k) {
    const Vec2 &a = p[k], &b = p[(k + 1) % p.size()];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return twice / 2;
}

Polyhedron moved(Polyhedron body, const Vec3& shift) {
  for (Vec3& v : body.vertices) v += shift;
  return body;
}

Quat any_turn(Random& random) {
  return Quat(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1),
              random.uniform(-1, 1))
      .normalized();
}

std::vector<Vec3> placed(const Polyhedron& body, const Pose& pose) {
  std::vector<Vec3> at;
  for (const Vec3& v : body.vertices) at.push_back(pose.x + pose.R * v);
  return at;
}

double overlap_volume(const GrainShape& a, const Pose& pa, const GrainShape& b, const Pose& pb) {
  ShapeTable table;
  const int i = table.add(a), j = table.add(b);
  OverlapWorkspace work;
  OverlapMoments moments;
  const ContactFrame frame = {0.5 * (pa.x + pb.x), Mat3::Identity()};
  overlap(table.view(i), pa, table.view(j), pb, frame, work, moments);
  return moments.volume;
}

Polyhedron prism(int sides, double radius, double height) {
  std::vector<Vec3> points;
  for (int k = 0; k < sides; ++k)
    for (int end : {-1, 1})
      points.emplace_back(radius * std::cos(2 * M_PI * k / sides),
                          radius * std::sin(2 * M_PI * k / sides), 0.5 * end * height);
  return convex_hull(points);
}

TEST(VolumeInside, BoxAgreesWithTheContactKernel) {
  Random random(3);
  const GrainShape box = make_grain_shape(make_box({0.8, 0.9, 1.1}));
  const MeasuredRegion region = box_region({-0.4, -0.45, -0.55}, {0.4, 0.45, 0.55});
  int cut = 0;
  for (const GrainShape& g : stones(60)) {
    const Pose pose = {any_turn(random).toRotationMatrix(),
                       Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1))};
    const Pose pb = {Mat3(box.turn), Vec3::Zero()};
    const double expected = overlap_volume(g, pose, box, pb);
    const double found = volume_inside(placed(g.body, pose), g.body.faces, region);
    EXPECT_NEAR(found, expected, 1e-12 * g.volume);
    cut += expected > 0 && expected < 0.999 * g.volume;
  }
  EXPECT_GT(cut, 30);
}

TEST(VolumeInside, CylinderAgreesWithAPrismOfManySides) {
  // A prism of n sides as wide as the circle of equal area: what differs falls as 1/n2.
  Random random(5);
  const int sides = 400;
  const double radius = 0.7, height = 1.2;
  const double corner = radius * std::sqrt(2 * M_PI / sides / std::sin(2 * M_PI / sides));
  const GrainShape many = make_grain_shape(prism(sides, corner, height));
  const MeasuredRegion region = cylinder_region({0, 0}, radius, -0.6, 0.6);
  for (const GrainShape& g : stones(10)) {
    const Pose pose = {any_turn(random).toRotationMatrix(),
                       Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1))};
    const double expected = overlap_volume(g, pose, many, {Mat3(many.turn), many.origin});
    EXPECT_NEAR(volume_inside(placed(g.body, pose), g.body.faces, region), expected,
                5e-5 * g.volume);
  }
}

TEST(VolumeInside, CylinderOfABoxInClosedForm) {
  const Polyhedron box = make_box({4, 4, 4});
  const double r = 0.5, h = 0.8, c = 0.3;  // the box's side cuts the circle at the distance c
  const auto inside = [&](const Vec3& shift, const MeasuredRegion& region) {
    return volume_inside(placed(box, {Mat3::Identity(), shift}), box.faces, region);
  };
  const MeasuredRegion whole = cylinder_region({0, 0}, r, 0, h);
  EXPECT_NEAR(inside({0, 0, 0}, whole), M_PI * r * r * h, 1e-14);
  const double segment = r * r * std::acos(c / r) - c * std::sqrt(r * r - c * c);
  EXPECT_NEAR(inside({2 + c, 0, 0}, whole), segment * h, 1e-14);
  EXPECT_NEAR(inside({0, 0, 2 + h / 4}, whole), M_PI * r * r * h * 3 / 4, 1e-14);
  // Tilted by 30 degrees about y through the axis at mid height: half of the cylinder.
  const Mat3 tilt = Eigen::AngleAxisd(M_PI / 6, Vec3::UnitY()).toRotationMatrix();
  const Pose pose = {tilt, Vec3(0, 0, h / 2) + tilt * Vec3(0, 0, -2)};
  EXPECT_NEAR(volume_inside(placed(box, pose), box.faces, whole), M_PI * r * r * h / 2, 1e-12);
}

TEST(VolumeInside, PartsAddUpToTheWhole) {
  Random random(7);
  for (const GrainShape& g : stones(8)) {
    const std::vector<Vec3> at =
        placed(g.body, {any_turn(random).toRotationMatrix(), Vec3::Zero()});
    double sum = 0;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        for (int k = 0; k < 3; ++k)
          sum += volume_inside(
              at, g.body.faces,
              box_region(Vec3(i, j, k) - Vec3::Constant(1.5), Vec3(i, j, k) - Vec3::Constant(0.5)));
    EXPECT_NEAR(sum, g.volume, 1e-13 * g.volume);
  }
}

TEST(VolumeInside, HorizontalFacesOnTheBorderCountOnce) {
  const Polyhedron box = make_box({1, 1, 1});
  for (double low : {-0.5, 0.0, -1.0})
    for (double high : {0.5, 0.25, 1.0})
      EXPECT_NEAR(volume_inside(box.vertices, box.faces, box_region({-1, -1, low}, {1, 1, high})),
                  std::min(0.5, high) - std::max(-0.5, low), 1e-15);
}

TEST(VolumeInside, SphereCapsAndClumpsBySlices) {
  const std::vector<Sphere> ball = {{Vec3(0.1, 0.2, 0.3), 1.0}};
  const auto cap = [](double h) { return M_PI * h * h * (3 - h) / 3; };
  const double whole = 4 * M_PI / 3;
  EXPECT_NEAR(volume_inside(ball, box_region({-3, -3, -3}, {3, 3, 3})), whole, 1e-3 * whole);
  EXPECT_NEAR(volume_inside(ball, box_region({-3, -3, 0.8}, {3, 3, 3})), cap(0.5), 1e-3 * whole);
  EXPECT_NEAR(volume_inside(ball, box_region({0.6, -3, -3}, {3, 3, 3})), cap(0.5), 1e-3 * whole);
  EXPECT_NEAR(volume_inside(ball, box_region({-3, -3, -3}, {3, -0.3, 3})), cap(0.5), 1e-3 * whole);
  // A narrow upright cylinder through the middle: cylinder and two caps (napkin ring).
  const double r = 0.4, half = std::sqrt(1 - r * r);
  const double core = whole - 4 * M_PI / 3 * half * half * half;
  EXPECT_NEAR(volume_inside(ball, cylinder_region({0.1, 0.2}, r, -3, 3)), core, 1e-3 * whole);
  // A clump of 93 spheres or so: quarters add up to the closed form of the whole.
  LibraryParameters p;
  p.count = 1;
  const ClumpShape clump = make_clump_library(p).front();
  double sum = 0;
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j)
      sum += volume_inside(clump.spheres,
                           box_region(Vec3(4 * i - 4, 4 * j - 4, -4), Vec3(4 * i, 4 * j, 4)));
  EXPECT_NEAR(sum, clump.volume, 1e-3 * clump.volume);
}

TEST(VolumeInside, DilatedGrainByItsOutline) {
  // A cube of edge 1 dilated by r, above the height t over its top face, in closed form.
  for (double r : {0.1, 0.5}) {
    const DilatedPolyhedron cube = {make_box({1, 1, 1}), r};
    PlacedGrain g = of_bodies({rounded_outline(cube.core, r)});
    g.radius = 2, g.volume = dilated_volume(cube);
    for (double t : {-0.3, 0.0, 0.4}) {  // share of r
      const double h = t * r;
      const auto disc = [&](double s) {  // integral of sqrt(r2 - s2)
        return 0.5 * (s * std::sqrt(r * r - s * s) + r * r * std::asin(s / r));
      };
      const double from = std::max(0.0, h), x = r - from;
      double expected = x + 4 * (disc(r) - disc(from)) +
                        M_PI * (r * r * x - (r * r * r - from * from * from) / 3);
      if (h < 0) expected += -h * (1 + 4 * r + M_PI * r * r);
      const RegionMeasure m =
          measure({g}, {}, Vec3::Zero(), box_region({-3, -3, 0.5 + h}, {3, 3, 3}));
      EXPECT_NEAR(m.solid_volume, expected, 1e-3 * g.volume) << r << " " << t;
    }
  }
}

// Unit cubes on a lattice, each with its six neighbours: porosity 0 inside.
struct Lattice {
  GrainShape cube = make_grain_shape(make_box({1, 1, 1}));
  std::vector<PlacedGrain> grains;
  std::vector<std::pair<int, int>> contacts;
  explicit Lattice(int n) {
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        for (int k = 0; k < n; ++k) {
          PlacedGrain g = of_bodies({cube.body});
          g.x = Vec3(i + 0.5, j + 0.5, k + 0.5);
          g.radius = cube.radius, g.volume = 1, g.density = 2600;
          const int me = int(grains.size());
          if (i > 0) contacts.emplace_back(me - n * n, me);
          if (j > 0) contacts.emplace_back(me - n, me);
          if (k > 0) contacts.emplace_back(me - 1, me);
          grains.push_back(g);
        }
  }
};

TEST(Measure, ShapesOfParts) {
  // Each grain half in the region by symmetry of its own body: a ball, a dilated cube, two cubes.
  const GrainShape shapes[] = {
      sphere_shape(0.5), as_grain(make_dilated_shape({make_box({1, 1, 1}), 0.2})),
      union_shape({make_box({1, 1, 1}), moved(make_box({1, 1, 1}), {1, 0, 0})})};
  for (const GrainShape& s : shapes) {
    ShapeTable table;
    Bodies bodies;
    add_grain(bodies, table, table.add(s), 0, 2000, Vec3(0, 0, 0), Quat::Identity());
    const auto grains = placed_grains(bodies, table);
    const RegionMeasure m = measure(grains, {}, Vec3::Zero(), box_region({-3, -3, 0}, {3, 3, 3}));
    EXPECT_NEAR(m.solid_volume, s.volume / 2, 1e-3 * s.volume);
    EXPECT_NEAR(m.mass, 2000 * m.solid_volume, 1e-6 * m.mass);
    double all = 0;
    for (const SectionPiece& p : section(grains, Vec3::Zero(), {2, 0})) all += area(p.outline);
    EXPECT_GT(all, 0.7);
  }
}

TEST(Measure, LatticeOfCubes) {
  const Lattice l(4);
  const RegionMeasure m =
      measure(l.grains, l.contacts, Vec3::Zero(), box_region({0.7, 0.8, 0.9}, {2.6, 2.7, 2.8}));
  EXPECT_NEAR(m.porosity, 0, 1e-14);
  EXPECT_NEAR(m.density, 2600, 1e-9);
  EXPECT_EQ(m.grains, 8);  // centres at 1.5, 2.5 along each axis
  EXPECT_DOUBLE_EQ(m.coordination, 6);
  const auto layers =
      measure_layers(l.grains, l.contacts, Vec3::Zero(), box_region({0, 0, -1}, {4, 4, 5}), 3);
  EXPECT_NEAR(layers[0].porosity, 0.5, 1e-14);
  EXPECT_NEAR(layers[1].porosity, 0, 1e-14);
  EXPECT_NEAR(layers[2].void_ratio, 1, 1e-13);
}

TEST(Measure, GrainsThatTouchTwiceAreOneContact) {
  // Two dumb-bells side by side, a third apart from them.
  const GrainShape bell = as_grain(make_clump_shape({{{0, -.8, 0}, .5}, {{0, .8, 0}, .5}}));
  Scene s(1e9, 0);
  s.context.gravity.setZero();
  for (const double x : {0., .99, 3.}) s.add(bell, 1, {x, 0, 0}, bell.turn);
  s.prepare();
  EXPECT_EQ(count_contacts(s.pairs), 2);
  EXPECT_EQ(grain_contacts(s.pairs, 3), (std::vector<std::pair<int, int>>{{0, 1}}));
}

TEST(Measure, PeriodicImagesCount) {
  Lattice l(1);  // a cube whose images tile the plane
  l.grains[0].R = Eigen::AngleAxisd(0.3, Vec3::UnitZ()).toRotationMatrix();
  const RegionMeasure m =
      measure(l.grains, {}, Vec3(1, 1, 0), box_region({-2, -2, 0.25}, {3, 3, 0.75}));
  EXPECT_NEAR(m.porosity, 0, 1e-13);  // overlaps and gaps of turned tiles cancel: mass is kept
}

TEST(Measure, ThreadsDoNotMatterAndBadRegionsAreRefused) {
  EXPECT_THROW(box_region({0, 0, 0}, {1, 0, 1}), InputError);
  EXPECT_THROW(cylinder_region({0, 0}, -1, 0, 1), InputError);
  EXPECT_THROW(cylinder_region({0, 0}, 1, 0, NAN), InputError);
  const Lattice l(2);
  EXPECT_THROW(measure_layers(l.grains, {}, Vec3::Zero(), box_region({0, 0, 0}, {1, 1, 1}), 0),
               InputError);
}

TEST(Section, AreasIntegrateToTheVolume) {
  // Simpson's rule is exact between the heights of the corners only; many cuts come close.
  Random random(11);
  for (const GrainShape& shape : stones(3)) {
    PlacedGrain g = of_bodies({shape.body});
    g.radius = shape.radius, g.volume = shape.volume;
    g.R = any_turn(random).toRotationMatrix();
    for (int axis = 0; axis < 3; ++axis) {
      double sum = 0;
      const int cuts = 2000;
      for (int k = 0; k < cuts; ++k) {
        const double at = -g.radius + (k + 0.5) * 2 * g.radius / cuts;
        for (const SectionPiece& p : section({g}, Vec3::Zero(), {axis, at}))
          sum += area(p.outline) * 2 * g.radius / cuts;
      }
      EXPECT_NEAR(sum, shape.volume, 1e-5 * shape.volume);
    }
  }
}

TEST(Section, CubesAndDiscs) {
  const Lattice l(2);
  const auto pieces = section(l.grains, Vec3::Zero(), {2, 0.5});
  ASSERT_EQ(pieces.size(), 4u);
  for (const SectionPiece& p : pieces) EXPECT_NEAR(area(p.outline), 1, 1e-15);
  PlacedGrain g;
  g.outline = std::make_shared<GrainOutline>(GrainOutline{{}, {{Vec3::Zero(), 1}}});
  g.radius = 1;
  const auto discs = section({g}, Vec3::Zero(), {0, 0.6});
  ASSERT_EQ(discs.size(), 1u);
  for (const Vec2& p : discs[0].outline) EXPECT_NEAR(p.norm(), 0.8, 1e-15);
  EXPECT_TRUE(section({g}, Vec3::Zero(), {0, 1.1}).empty());
  // Across a seam the image is drawn too.
  EXPECT_EQ(section({g}, Vec3(3, 0, 0), {0, 2.9}).size(), 1u);
}

}  // namespace
}  // namespace trackbed::dem
