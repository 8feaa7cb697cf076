// Solids from files: what is read, and the one line that each bad file gets.
#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>

#include "base/error.h"
#include "dem/grain/clump_io.h"
#include "dem/grain/library.h"
#include "dem/grain/off_io.h"
#include "tests/scratch_folder.h"
#include "tests/unit/grain_solids.h"

namespace trackbed::dem {
namespace {

class Files : public ::testing::Test, public ScratchFolder {
 protected:
  // The file is refused in one line that names it and holds `part`.
  void refused(const std::string& name, const std::string& text, const std::string& part) {
    const std::string path = text.empty() ? file(name) : write(name, text);
    try {
      read_solid(path);
      ADD_FAILURE() << name << " was read";
    } catch (const InputError& e) {
      const std::string what = e.what();
      EXPECT_NE(what.find(path), std::string::npos) << what;
      EXPECT_NE(what.find(part), std::string::npos) << what;
      EXPECT_EQ(what.find('\n'), std::string::npos) << what;
    }
  }
};

const std::string vertices = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n";
const std::string faces = "3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n";

TEST_F(Files, OffRoundTripKeepsAllDigits) {
  const Polyhedron given = solids::moved(solids::icosahedron(), solids::any_turn, {1, 2, 3});
  write_off(file("a.off"), given);
  const Polyhedron read = read_solid(file("a.off"));
  EXPECT_EQ(read.vertices.size(), 12u);
  EXPECT_EQ(read.faces.size(), 20u);
  EXPECT_NEAR(mass_properties(read).volume / mass_properties(given).volume, 1, 1e-14);
}

TEST_F(Files, OffWithCommentsUnitAndColours) {
  const std::string path = write("a.off", "OFF # a corner\n4 4 0\n\n" + vertices +
                                              "3 0 2 1 255 0 0\n3 0 1 3\n3 1 2 3\n3 0 3 2\n");
  EXPECT_NEAR(mass_properties(read_solid(path)).volume, 1. / 6, 1e-15);
  EXPECT_NEAR(mass_properties(read_solid(path, {0.001, false})).volume, 1e-9 / 6, 1e-24);
}

TEST_F(Files, ObjWithNormalsAndNegativeIndices) {
  const std::string path = write("a.OBJ",
                                 "o corner\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvn 0 0 1\n"
                                 "f 1//1 3//1 2//1\nf 1/1 2/2 4/3\nf -3 -2 -1\nf 1 4 3\n");
  EXPECT_NEAR(mass_properties(read_solid(path)).volume, 1. / 6, 1e-15);
}

std::string stl_cube(bool binary) {  // 12 triangles, turned, single precision
  const Polyhedron cube = solids::moved(make_box({1, 1, 1}), solids::any_turn, {0, 0, 0});
  std::string ascii = "solid cube\n", bytes(80, ' ');
  const std::uint32_t count = 12;
  bytes.append(reinterpret_cast<const char*>(&count), 4);
  for (const auto& f : cube.faces)
    for (int k : {1, 2}) {
      float values[12] = {0, 0, 0};
      ascii += "facet normal 0 0 0\nouter loop\n";
      for (int c = 0; c < 3; ++c) {
        const Vec3& v = cube.vertices[f[c == 0 ? 0 : k + c - 1]];
        for (int d = 0; d < 3; ++d) values[3 + 3 * c + d] = float(v[d]);
        ascii += "vertex " + std::to_string(v.x()) + " " + std::to_string(v.y()) + " " +
                 std::to_string(v.z()) + "\n";
      }
      ascii += "endloop\nendfacet\n";
      bytes.append(reinterpret_cast<const char*>(values), 48);
      bytes.append(2, '\0');
    }
  return binary ? bytes : ascii + "endsolid cube\n";
}

TEST_F(Files, StlAsciiAndBinaryMergeTheirTriangles) {
  const Polyhedron b = read_solid(write("b.stl", stl_cube(true)));
  EXPECT_EQ(b.vertices.size(), 8u);
  EXPECT_EQ(b.faces.size(), 6u);
  EXPECT_NEAR(mass_properties(b).volume, 1, 1e-6);
  const Polyhedron a = read_solid(write("a.stl", stl_cube(false)));
  EXPECT_EQ(a.vertices.size(), 8u);
  EXPECT_NEAR(mass_properties(a).volume, 1, 1e-5);
}

TEST_F(Files, BadSolids) {
  const std::string head = "OFF\n4 4 6\n";
  refused("open.off", "OFF\n4 3 6\n" + vertices + "3 0 2 1\n3 0 1 3\n3 1 2 3\n", "open");
  refused("inside.off", head + vertices + "3 0 1 2\n3 0 3 1\n3 1 3 2\n3 0 2 3\n", "inside-out");
  refused("wound.off", head + vertices + "3 0 1 2\n3 0 1 3\n3 1 2 3\n3 0 3 2\n", "wound");
  refused("nan.off", head + "0 0 0\n1 0 nan\n0 1 0\n0 0 1\n" + faces, "line 4: coordinate 'nan'");
  refused("inf.off", head + "0 0 0\n1 0 inf\n0 1 0\n0 0 1\n" + faces, "not a finite");
  refused("flat.off", head + "0 0 0\n1 0 0\n0 1 0\n1 1 0\n" + faces, "no volume");
  refused("point.off", head + "1 1 1\n1 1 1\n1 1 1\n1 1 1\n" + faces, "no volume");
  refused("index.off", head + vertices + "3 0 2 4\n3 0 1 3\n3 1 2 3\n3 0 3 2\n", "does not exist");
  refused("short.off", head + vertices + "3 0 2 1\n", "ends too early");
  refused("word.off", head + "0 0 zero\n" + vertices + faces, "'zero' is not a number");
  refused("head.off", "PLY\n4 4 6\n", "OFF");
  refused("two.off", head + vertices + "2 0 2\n3 0 1 3\n3 1 2 3\n3 0 3 2\n", "fewer than 3");
  refused("none.off", "OFF\n0 0 0\n", "no faces");
  refused("a.ply", "ply\n", ".off, .obj and .stl");
  refused("a.stl", "not a solid at all", "STL");
  refused("cut.stl", stl_cube(true).substr(0, 300), "STL");
  refused("early.stl", "solid a\nfacet\nouter loop\nvertex 0 0 0\n", "ends too early");
  refused("a.obj", "v 0 0 0\nv 1 0 0\nf 1 2 x\n", "'x' is not a vertex index");
  refused("zero.obj", "v 0 0 0\nv 1 0 0\nf 1 2 0\n", "does not exist");
  refused("missing.off", "", "cannot be opened");
  refused("pair.off",
          "OFF\n8 8 0\n" + vertices + "5 0 0\n6 0 0\n5 1 0\n5 0 1\n" + faces +
              "3 4 6 5\n3 4 5 7\n3 5 6 7\n3 4 7 6\n",
          "more than one solid");
}

// A cube whose top has a pit: closed, not convex.
const std::string pit =
    "OFF\n9 9 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n.5 .5 .5\n"
    "4 0 3 2 1\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n"
    "3 4 5 8\n3 5 6 8\n3 6 7 8\n3 7 4 8\n";

TEST_F(Files, NotConvexIsRefusedOrReplacedByItsHull) {
  refused("pit.off", pit, "not convex");
  const Polyhedron hull = read_solid(file("pit.off"), {1, true});
  EXPECT_EQ(hull.faces.size(), 6u);
  EXPECT_NEAR(mass_properties(hull).volume, 1, 1e-14);
}

// A scanned stone as it is: mass, depth, convex parts, and the way back to a file.
TEST_F(Files, NotConvexIsReadAsTriangles) {
  const TriangleSolid solid = read_triangle_solid(write("pit.off", pit), 0.001);
  const MassProperties p = mass_properties(solid);
  EXPECT_NEAR(p.volume, 5 / 6. * 1e-9, 1e-22);  // a pyramid of height 1/2 is missing
  EXPECT_NEAR(p.centroid.z(), (0.5 - 0.875 / 6) / (5 / 6.) * 1e-3, 1e-15);
  EXPECT_GT(depth(solid, {0.5e-3, 0.5e-3, 0.25e-3}), 0);
  EXPECT_LT(depth(solid, {0.5e-3, 0.5e-3, 0.75e-3}), 0);
  double volume = 0;
  for (const Polyhedron& part : star_parts(solid, {0.5e-3, 0.5e-3, 0.25e-3}))
    volume += mass_properties(part).volume;
  EXPECT_NEAR(volume, p.volume, 1e-22);
  EXPECT_THROW(star_parts(solid, {0.1e-3, 0.1e-3, 0.9e-3}), InputError);
  write_off(file("copy.off"), solid);
  const TriangleSolid copy = read_triangle_solid(file("copy.off"));
  EXPECT_EQ(copy.triangles.size(), solid.triangles.size());
  EXPECT_NEAR(mass_properties(copy).volume, p.volume, 1e-22);
  EXPECT_THROW(read_triangle_solid(write("open.off", pit.substr(0, pit.size() - 8))), InputError);
}

TEST_F(Files, SelfIntersectionIsNamed) {
  std::string deep = pit;  // the pit's point below the bottom
  deep.replace(deep.find(".5 .5 .5"), 8, ".5 .5 -1");
  deep = "OFF\n9 9 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n.5 .5 -.4\n" +
         deep.substr(deep.find("4 0 3 2 1"));
  refused("deep.off", deep, "intersects itself");
  EXPECT_THROW(read_triangle_solid(write("deep.off", deep)), InputError);
}

TEST_F(Files, UnwritablePathIsNamed) {
  const std::string path = file("no/such/folder/a.off");
  try {
    write_off(path, make_box({1, 1, 1}));
    FAIL();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find(path), std::string::npos);
  }
}

TEST_F(Files, SeveralSolidsInOneFile) {
  // Two tetrahedra, one turned on: OFF by vertices of their own, STL as a soup of triangles.
  const std::string off =
      write("two.off",
            "OFF\n8 8 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n5 0 0\n7 0 0\n5 2 0\n5 0 2\n"
            "3 0 2 1\n3 4 6 5\n3 0 1 3\n3 4 5 7\n3 1 2 3\n3 5 6 7\n3 2 0 3\n3 6 4 7\n");
  const std::vector<Polyhedron> solids = read_solids(off, {0.001, false});
  ASSERT_EQ(solids.size(), 2u);
  EXPECT_NEAR(mass_properties(solids[0]).volume, 1e-9 / 6, 1e-21);
  EXPECT_NEAR(mass_properties(solids[1]).volume, 8e-9 / 6, 1e-20);
  EXPECT_THROW(read_solid(off), InputError);
  std::string stl = "solid a\n";
  const Vec3 corner[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (double shift : {0.0, 3.0})
    for (const auto& f : {Eigen::Vector3i(0, 2, 1), Eigen::Vector3i(0, 1, 3),
                          Eigen::Vector3i(1, 2, 3), Eigen::Vector3i(2, 0, 3)}) {
      stl += "facet normal 0 0 0\nouter loop\n";
      for (int k = 0; k < 3; ++k)
        stl += "vertex " + std::to_string(corner[f[k]].x() + shift) + " " +
               std::to_string(corner[f[k]].y()) + " " + std::to_string(corner[f[k]].z()) + "\n";
      stl += "endloop\nendfacet\n";
    }
  EXPECT_EQ(read_solids(write("two.stl", stl + "endsolid a\n")).size(), 2u);
}

TEST_F(Files, ClumpsFromCsv) {
  const auto spheres =
      read_clump(write("c.csv", "x,y,z,r\n1,2,3,4\n\n -1 , 0.5 ,0, 2e-1\r\n"), 1e-3);
  ASSERT_EQ(spheres.size(), 2u);
  EXPECT_NEAR(spheres[0].radius, 4e-3, 1e-18);
  EXPECT_NEAR(spheres[1].centre.y(), 0.5e-3, 1e-18);
  const auto bad = [&](const std::string& text, const std::string& part) {
    const std::string path = write("bad.csv", text);
    try {
      read_clump(path);
      ADD_FAILURE() << text;
    } catch (const InputError& e) {
      EXPECT_NE(std::string(e.what()).find(path + ": " + part), std::string::npos) << e.what();
    }
  };
  bad("1,2,3\n", "line 1: a sphere is four numbers");
  bad("1,2,3,4\n1,2,x,4\n", "line 2: 'x' is not a number");
  bad("nan,2,3,4\n", "line 1: 'nan' is not a finite number");
  bad("1,2,3,0\n", "line 1: the radius must be positive");
  bad("x,y,z,r\n", "holds no sphere");
}

TEST_F(Files, StonesMakeALibrary) {
  LibraryParameters p;
  p.generator = "files";
  EXPECT_THROW(make_library(p), InputError);
  p.files = {file("box.off"), file("tetrahedron.off")};
  write_off(p.files[0], make_box({62, 62, 100}));
  write_off(p.files[1], solids::tetrahedron());
  const auto library = make_library(p);
  ASSERT_EQ(library.size(), 2u);
  EXPECT_NEAR(library[0].volume, 100. / 62, 1e-6);  // of sieve size 1 m
  EXPECT_NEAR(library[1].volume, 1 / 3., 1e-6);     // (1 / 6 sqrt2) / (1 / sqrt2)^3
  p.needles = 3;
  EXPECT_THROW(make_library(p), InputError);
}

}  // namespace
}  // namespace trackbed::dem
