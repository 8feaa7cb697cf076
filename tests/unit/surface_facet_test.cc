// What a grain has behind a facet, cut out in one, against the facet's three tetrahedra.
#include <gtest/gtest.h>

#include "dem/grain/random.h"
#include "dem/grain/voronoi.h"
#include "dem/surface/facet_cut.h"
#include "dem/surface/shell_cell.h"
#include "surface_scene.h"

namespace trackbed::dem {
namespace {

struct Cut {
  OverlapMoments moments;  // about the frame's origin
  Vec3 surface = Vec3::Zero();
  int pieces = 0;
};

void add(const OverlapMoments& m, OverlapMoments& sum) {
  const Vec3& d = m.about;
  sum.volume += m.volume;
  sum.first += m.first + m.volume * d;
  sum.second +=
      m.second + m.first * d.transpose() + d * m.first.transpose() + m.volume * d * d.transpose();
}

Cut by_cells(const ConvexView& grain, const Pose& pose, const SurfacePatch& patch, int triangle,
             const ContactFrame& frame) {
  Cut cut;
  for (int k = 3 * triangle; k < 3 * triangle + 3; ++k) {
    ShellCell cell;
    make_shell_cell(patch, k, Vec3::Zero(), cell);
    OverlapWorkspace work;
    OverlapMoments m;
    if (!overlap(grain, pose, cell.view, {Mat3::Identity(), cell.origin}, frame, work, m)) continue;
    add(m, cut.moments);
    for (const OverlapPiece& p : work.b_pieces)
      if (p.face == cell.outer_face) cut.surface += p.area, ++cut.pieces;
  }
  return cut;
}

// By the closed form, in world axes.
bool by_vertex(const ConvexView& grain, const Pose& pose, const SurfacePatch& patch, int triangle,
               Cut& cut) {
  Facet facet;
  make_facet(patch, triangle, Vec3::Zero(), facet);
  GrainBelow at;
  find_below(grain, pose, facet, at);
  OverlapWorkspace work;
  OverlapMoments m;
  ContactFrame frame;
  if (!vertex_behind_facet(grain, pose, facet, at, frame, work, m)) return false;
  EXPECT_EQ(work.b_pieces.size(), 1u);
  EXPECT_NEAR(m.first.norm(), 0, 0);
  // Into the world, about its origin.
  const Vec3 c = frame.axes * m.about + frame.origin;
  cut.moments.volume = m.volume;
  cut.moments.first = m.volume * c;
  cut.moments.second =
      frame.axes * m.second * frame.axes.transpose() + m.volume * c * c.transpose();
  cut.surface = frame.axes * work.b_pieces[0].area;
  return true;
}

FacetOverlap in_one(const ConvexView& grain, const Pose& pose, const SurfacePatch& patch,
                    int triangle, const ContactFrame& frame, Cut& cut) {
  Facet facet;
  make_facet(patch, triangle, Vec3::Zero(), facet);
  GrainBelow at;
  EXPECT_TRUE(find_below(grain, pose, facet, at));
  OverlapWorkspace work;
  OverlapMoments m;
  const FacetOverlap answer = cut_behind_facet(grain, pose, facet, at, frame, work, m);
  if (answer != FacetOverlap::cut) return answer;
  add(m, cut.moments);
  for (const OverlapPiece& p : work.b_pieces) cut.surface += p.area, ++cut.pieces;
  return answer;
}

void expect_same(const Cut& a, const Cut& b, double size) {
  EXPECT_NEAR(a.moments.volume, b.moments.volume, 1e-13 * std::pow(size, 3));
  EXPECT_LE((a.moments.first - b.moments.first).norm(), 1e-13 * std::pow(size, 4));
  EXPECT_LE((a.moments.second - b.moments.second).norm(), 1e-13 * std::pow(size, 5));
  EXPECT_LE((a.surface - b.surface).norm(), 1e-13 * size * size);
}

TEST(Facet, cuts_as_its_three_cells) {
  VoronoiParameters v;
  v.count = 20, v.seed = 5;
  const auto grains = voronoi_grains(v);
  Random random(12);
  int cut = 0, left = 0, vertices = 0, corners[3] = {};
  for (int k = 0; k < 300; ++k) {
    // Facets larger and smaller than the grain; flat when the shell was made, bent since; or folded
    // at an edge, where the sides are no planes.
    const bool folded = k % 5 == 4;
    const int n = std::array<int, 3>{2, 5, 12}[k % 3];
    const Mesh mesh = folded ? edge_mesh(n, 2 * n, 2) : flat_mesh(n, n + 1, -2, 2, -2, 2);
    SurfacePatch patch = make_patch("patch", 0, mesh.nodes, mesh.quads, .15, 0, Vec3::Zero());
    for (Vec3& p : patch.node)
      p += .01 * random.uniform() * random.direction() +
           Vec3(0, 0, random.uniform(-.02, .02) * p.x() * p.x());
    ShapeTable shapes;
    const GrainShape shape = make_grain_shape(grains[k % 20]);
    const ConvexView grain = shapes.view(shapes.add(shape));
    Pose pose;
    pose.R = Quat(Eigen::AngleAxisd(random.uniform(0, 6), random.direction())).toRotationMatrix();
    const Vec3 up = folded ? Vec3(random.uniform(0, 1), 0, 1).normalized() : Vec3(0, 0, 1);
    double low = HUGE_VAL;
    for (int i = 0; i < grain.vertices; ++i)
      low = std::min(low, up.dot(pose.R * Vec3(grain.x[i], grain.y[i], grain.z[i])));
    const double depth = std::pow(10, random.uniform(-4, -1.1));
    pose.x =
        Vec3(folded ? 0 : random.uniform(-.5, .5), random.uniform(-.5, .5), 0) - (low + depth) * up;
    const ContactFrame frame{pose.x + low * up, axes_along(-up)};
    for (int t = 0; t < static_cast<int>(patch.triangle.size()); ++t) {
      Cut one;
      const FacetOverlap answer = in_one(grain, pose, patch, t, frame, one);
      const Cut cells = by_cells(grain, pose, patch, t, frame);
      if (answer == FacetOverlap::not_for_one_facet) {
        left += cells.moments.volume > 0;
        continue;
      }
      expect_same(one, cells, 1);
      Cut vertex;
      if (by_vertex(grain, pose, patch, t, vertex)) {
        ++vertices;
        const ContactFrame world{Vec3::Zero(), Mat3::Identity()};
        expect_same(vertex, by_cells(grain, pose, patch, t, world), 1);
      }
      if (answer == FacetOverlap::cut) ++cut, ++corners[std::min(one.pieces, 2)];
    }
  }
  EXPECT_GT(cut, 300);
  EXPECT_GT(vertices, 50);
  EXPECT_LT(left, cut / 2);
  EXPECT_EQ(corners[2], 0);  // the surface inside the grain is one piece
}

// Sides that run along the grain's own faces and edges: each part of the grain counts once.
TEST(Facet, parts_a_cube_along_its_faces) {
  const Mesh mesh = flat_mesh(8, 8, -1, 1, -1, 1);
  const SurfacePatch patch = make_patch("patch", 0, mesh.nodes, mesh.quads, .2, 0, Vec3::Zero());
  ShapeTable shapes;
  const ConvexView cube = shapes.view(shapes.add(make_grain_shape(make_box({1, 1, 1}))));
  for (const Vec3& at : {Vec3(0, 0, .45), Vec3(.25, 0, .45), Vec3(.125, .125, .45)}) {
    const Pose pose{Mat3::Identity(), at};
    Cut sum;
    for (int t = 0; t < static_cast<int>(patch.triangle.size()); ++t)
      EXPECT_NE(in_one(cube, pose, patch, t, {at - Vec3(0, 0, .5), axes_along({0, 0, -1})}, sum),
                FacetOverlap::not_for_one_facet);
    EXPECT_NEAR(sum.moments.volume, .05, 1e-14);
    EXPECT_NEAR(sum.surface.z(), -1, 1e-13);
  }
}

}  // namespace
}  // namespace trackbed::dem
