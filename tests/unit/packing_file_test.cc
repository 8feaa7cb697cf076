// Packings to files and back: the same solids to 1e-12; malformed files in one line.
#include "dem/packing/packing_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "base/error.h"
#include "dem/grain/library.h"
#include "dem/grain/parts.h"
#include "dem/grain/random.h"
#include "tests/scratch_folder.h"

namespace trackbed::dem {
namespace {

PackedGrains sample() {
  PackedGrains g;
  LibraryParameters p;
  p.count = 30;
  Random random(5);
  for (const GrainShape& shape : make_library(p)) {
    const Quat q(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1),
                 random.uniform(-1, 1));
    const GrainShape grain = scaled(shape, random.uniform(.02, .06));
    g.add(grain, 3 * random.direction(), q.normalized());
    g.add(grain, 3 * random.direction(), q.normalized());  // shapes may be shared
  }
  return g;
}

std::string write_csv(const ScratchFolder& folder, const PackedGrains& g) {
  const DistinctShapes d = distinct_shapes(g);
  std::filesystem::create_directories(folder.file("p_shapes"));
  for (std::size_t k = 0; k < d.first_of.size(); ++k) {
    const ShapeFile shape = shape_file(g.shape[d.first_of[k]]);
    folder.write("p_shapes/" + std::to_string(k) + shape.ending, shape.text);
  }
  return folder.write("p.csv", packing_csv_text(g, d.shape_of));
}

// Corners in the world of each grain, whatever frame it is kept in: every one of `a` is one of `b`.
double corner_distance(const PackedGrains& a, const PackedGrains& b, int i) {
  double worst = 0;
  for (const Vec3& p : a.shape[i].body.vertices) {
    double nearest = 1;
    for (const Vec3& q : b.shape[i].body.vertices)
      nearest =
          std::min(nearest, (a.centre[i] + a.turn[i] * p - b.centre[i] - b.turn[i] * q).norm());
    worst = std::max(worst, nearest);
  }
  return worst;
}

void expect_same(const PackedGrains& a, const PackedGrains& b) {
  ASSERT_EQ(a.size(), b.size());
  for (int i = 0; i < a.size(); ++i) {
    ASSERT_EQ(a.shape[i].body.vertices.size(), b.shape[i].body.vertices.size());
    ASSERT_EQ(a.shape[i].body.faces.size(), b.shape[i].body.faces.size());
    EXPECT_LT(corner_distance(a, b, i), 1e-12);
    EXPECT_LT((a.centre[i] - b.centre[i]).norm(), 1e-12);
    EXPECT_NEAR(b.shape[i].volume / a.shape[i].volume, 1, 1e-12);
    EXPECT_LT((b.shape[i].inertia - a.shape[i].inertia).norm(), 1e-12 * a.shape[i].inertia.norm());
  }
}

TEST(PackingFile, csv_and_back) {
  const ScratchFolder folder;
  const PackedGrains g = sample();
  EXPECT_EQ(distinct_shapes(g).first_of.size(), 30u);
  const std::string file = write_csv(folder, g);
  const PackedGrains back = read_packing(file);
  expect_same(g, back);
  for (int i = 0; i < g.size(); ++i) EXPECT_EQ(back.shape[i].sieve_size, g.shape[i].sieve_size);
  EXPECT_EQ(packing_files(file).size(), 31u);
  EXPECT_EQ(packing_files(file)[0], file);
}

TEST(PackingFile, off_and_back) {
  const ScratchFolder folder;
  const PackedGrains g = sample();
  expect_same(g, read_packing(folder.write("p.off", packing_off_text(g))));
}

// Cubes face on face have corners in one place and still are eight.
TEST(PackingFile, grains_that_touch_are_told_apart) {
  const ScratchFolder folder;
  PackedGrains g;
  const GrainShape cube = make_grain_shape(make_box({.1, .1, .1}));
  for (int i = 0; i < 8; ++i) g.add(cube, .1 * Vec3(i % 2, i / 2 % 2, i / 4), cube.turn);
  expect_same(g, read_packing(folder.write("p.off", packing_off_text(g))));
}

TEST(PackingFile, vtu_holds_every_corner_and_face_once) {
  const PackedGrains g = sample();
  const std::string text = packing_vtu_text(g);
  std::size_t corners = 0;
  for (const GrainShape& s : g.shape) corners += s.body.vertices.size();
  EXPECT_NE(text.find("NumberOfPoints=\"" + std::to_string(corners) + "\" NumberOfCells=\"60\""),
            std::string::npos);
  EXPECT_EQ(text.find("nan"), std::string::npos);
}

// Two spheres, two unlike clumps of the same spheres' sizes, a dilated box, a plain one.
PackedGrains rounded_sample() {
  const auto sized = [](GrainShape s, double size) {
    s.sieve_size = size;
    return s;
  };
  DilatedShape box = make_dilated_shape({make_box({.03, .04, .05}), .004});
  const std::vector<Sphere> corner{{{0, 0, 0}, .02}, {{.02, 0, 0}, .012}, {{0, .025, .01}, .01}};
  std::vector<Sphere> other = corner;
  other[2].centre.z() = -.01;
  PackedGrains g;
  const Quat q = Quat(.3, -.5, .2, .7).normalized();
  for (const GrainShape& s :
       {sphere_shape(.02), sphere_shape(.03), sized(as_grain(make_clump_shape(corner)), .04),
        sized(as_grain(make_clump_shape(other)), .041), sized(as_grain(box), .045),
        sized(make_grain_shape(make_box({.03, .04, .05})), .04)}) {
    g.add(s, Vec3(.1 * g.size(), .2, .3), q);
    g.add(s, Vec3(.1 * g.size(), .4, .3), q.conjugate());
  }
  return g;
}

// Where a part's core lies in the world.
std::vector<Vec3> core_points(const PackedGrains& g, int i, int part) {
  std::vector<Vec3> points;
  for (const Vec3& v : g.shape[i].parts[part].core.vertices)
    points.push_back(g.centre[i] + g.turn[i] * v);
  return points;
}

TEST(PackingFile, spheres_clumps_and_dilated_grains_come_back_from_csv) {
  const ScratchFolder folder;
  const PackedGrains g = rounded_sample();
  EXPECT_EQ(distinct_shapes(g).first_of.size(), 6u);
  const PackedGrains back = read_packing(write_csv(folder, g));
  ASSERT_EQ(back.size(), g.size());
  for (int i = 0; i < g.size(); ++i) {
    EXPECT_EQ(back.shape[i].sieve_size, g.shape[i].sieve_size);
    EXPECT_NEAR(back.shape[i].volume / g.shape[i].volume, 1, 1e-12);
    EXPECT_LT((back.shape[i].inertia - g.shape[i].inertia).norm(),
              1e-12 * g.shape[i].inertia.norm());
    EXPECT_LT((back.centre[i] - g.centre[i]).norm(), 1e-12);
    ASSERT_EQ(back.shape[i].parts.size(), g.shape[i].parts.size());
    for (int k = 0; k < static_cast<int>(g.shape[i].parts.size()); ++k) {
      const ConvexPart &a = g.shape[i].parts[k], &b = back.shape[i].parts[k];
      EXPECT_EQ(a.radius, b.radius);
      EXPECT_NEAR(a.crown, b.crown, 1e-9 * a.crown);
      for (const Vec3& p : core_points(g, i, k)) {
        double nearest = 1;
        for (const Vec3& x : core_points(back, i, k)) nearest = std::min(nearest, (p - x).norm());
        EXPECT_LT(nearest, 1e-12) << i;
      }
    }
  }
}

TEST(PackingFile, grains_of_several_pieces_come_back_from_csv) {
  const ScratchFolder folder;
  const auto moved = [](Polyhedron p, const Vec3& by) {
    for (Vec3& v : p.vertices) v += by;
    return p;
  };
  // An L whose boxes share a face, and a T of three.
  const GrainShape ell =
      union_shape({make_box({.2, .1, .1}), moved(make_box({.1, .1, .1}), {0, .1, 0})});
  const GrainShape tee =
      union_shape({make_box({.1, .2, .1}), moved(make_box({.1, .1, .1}), {.1, 0, 0}),
                   moved(make_box({.1, .1, .1}), {-.1, 0, 0})});
  PackedGrains g;
  Random random(6);
  for (int i = 0; i < 6; ++i) {
    const Quat q(random.uniform(-1, 1), random.uniform(-1, 1), .5, random.uniform(-1, 1));
    g.add(i % 2 ? ell : tee, 3 * random.direction(), q.normalized());
    g.shape.back().sieve_size = .15;
  }
  const PackedGrains back = read_packing(write_csv(folder, g));
  ASSERT_EQ(back.size(), 6);
  for (int i = 0; i < 6; ++i) {
    ASSERT_EQ(back.shape[i].parts.size(), g.shape[i].parts.size());
    EXPECT_NEAR(back.shape[i].volume, g.shape[i].volume, 1e-15);
    EXPECT_LT((back.shape[i].inertia - g.shape[i].inertia).norm(), 1e-15);
    for (std::size_t k = 0; k < g.shape[i].parts.size(); ++k)
      for (const Vec3& p : core_points(g, i, static_cast<int>(k))) {
        double nearest = 1;
        for (const Vec3& x : core_points(back, i, static_cast<int>(k)))
          nearest = std::min(nearest, (p - x).norm());
        EXPECT_LT(nearest, 1e-12) << i;
      }
  }
}

TEST(PackingFile, outlines_of_round_grains_have_their_volume) {
  const ScratchFolder folder;
  const PackedGrains g = rounded_sample();
  EXPECT_NE(packing_vtu_text(g).find("NumberOfCells=\"20\""), std::string::npos);  // clumps: three
  EXPECT_THROW(packing_off_text(g), InputError);
  PackedGrains whole;
  for (int i = 0; i < g.size(); ++i)
    if (g.shape[i].parts.size() < 2) whole.add(g.shape[i], g.centre[i], g.turn[i]);
  const PackedGrains back = read_packing(folder.write("p.off", packing_off_text(whole)));
  ASSERT_EQ(back.size(), 8);
  for (int i = 0; i < back.size(); ++i) {
    EXPECT_NEAR(back.shape[i].volume / whole.shape[i].volume, 1, 1e-4);
    EXPECT_LT((back.centre[i] - whole.centre[i]).norm(), 1e-5);
  }
}

std::string complaint(const std::string& file) {
  try {
    read_packing(file);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST(PackingFile, malformed_files_are_named) {
  const ScratchFolder folder;
  const std::string good = write_csv(folder, sample());
  EXPECT_EQ(complaint(good), "");
  std::ifstream in(good);
  std::string header, first;
  std::getline(in, header), std::getline(in, first);
  const auto csv = [&](const std::string& text) { return folder.write("bad.csv", text); };
  EXPECT_NE(complaint(csv("grain,shape\n0,0\n")).find("column 'x_m'"), std::string::npos);
  EXPECT_NE(complaint(csv(header + "\n")).find("no grains"), std::string::npos);
  EXPECT_NE(complaint(csv(header + "\n0,0,nan,0,0,1,0,0,0,0,0\n")).find("line 2: x_m"),
            std::string::npos);
  EXPECT_NE(complaint(csv(header + "\n0,0,0,0,0,2,0,0,0,0,0\n")).find("quaternion"),
            std::string::npos);
  EXPECT_NE(complaint(csv(header + "\n" + first + "\n")).find("bad_shapes/0.off"),
            std::string::npos);
  const auto kind = [&](const std::string& cells) {
    return complaint(csv("shape,x_m,y_m,z_m,qw,qx,qy,qz,sieve_m,kind,radius_m\n0,0,0,0,1,0,0,0," +
                         cells + "\n"));
  };
  EXPECT_NE(kind("1,blob,0").find("line 2: kind = 'blob'"), std::string::npos);
  EXPECT_NE(kind("1,dilated,0").find("radius_m"), std::string::npos);
  EXPECT_NE(kind("0,spheres,0").find("sieve_m"), std::string::npos);
  EXPECT_NE(kind("1,spheres,0").find("bad_shapes/0.csv"), std::string::npos);
  EXPECT_NE(complaint(folder.file("none.csv")).find("cannot be opened"), std::string::npos);
  EXPECT_NE(complaint(folder.write("p.txt", "x")).find("unknown kind"), std::string::npos);
  // A face is missing from the second of two tetrahedra.
  const std::string tetrahedron = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n";
  const std::string open = "OFF\n8 7 0\n" + tetrahedron + tetrahedron +
                           "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n3 4 6 5\n3 4 5 7\n3 4 7 6\n";
  const std::string text = complaint(folder.write("open.off", open));
  EXPECT_NE(text.find("open.off: solid 2"), std::string::npos) << text;
  EXPECT_NE(text.find("open"), std::string::npos);
}

}  // namespace
}  // namespace trackbed::dem
