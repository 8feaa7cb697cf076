#include "dem/surface/patch.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <map>

#include "base/error.h"
#include "dem/surface/shell_cell.h"

namespace trackbed::dem {
namespace {

Vec3 normal_of(const std::vector<Vec3>& x, const std::array<int, 3>& t) {
  return (x[t[1]] - x[t[0]]).cross(x[t[2]] - x[t[0]]);
}

// The d of sum (n.d - value)^2 -> least, for sums A of n n^T and b of value n; no part of it along
// directions that the n hardly differ in (planes that meet at less than some 15 degrees count as
// one: facets of a curved or slightly warped surface).
Vec3 solve_planes(const Mat3& A, const Vec3& b) {
  const Eigen::SelfAdjointEigenSolver<Mat3> eigen(A);
  Vec3 d = Vec3::Zero();
  for (int k = 0; k < 3; ++k)
    if (eigen.eigenvalues()[k] > 0.02 * A.trace())
      d +=
          eigen.eigenvectors().col(k).dot(b) / eigen.eigenvalues()[k] * eigen.eigenvectors().col(k);
  return d;
}

using Edge = std::pair<int, int>;

// Directed edges that have no partner running the other way: the patch's border.
std::vector<Edge> border_edges(const std::vector<std::array<int, 4>>& quads) {
  std::map<Edge, int> count;
  for (const auto& q : quads)
    for (int k = 0; k < 4; ++k) ++count[{q[k], q[(k + 1) % 4]}];
  std::vector<Edge> border;
  for (const auto& [edge, n] : count)
    if (!count.count({edge.second, edge.first})) border.push_back(edge);
  return border;
}

bool on_seam(const Vec3& p, const Vec3& q, const Vec3& period) {
  for (int k = 0; k < 3; ++k)
    for (const double side : {-0.5 * period[k], 0.5 * period[k]})
      if (period[k] > 0 && std::abs(p[k] - side) < 1e-9 * period[k] &&
          std::abs(q[k] - side) < 1e-9 * period[k])
        return true;
  return false;
}

// Skirt: each border node gets an outer copy; each border edge an outer quad.
void add_skirt(SurfacePatch& patch, std::vector<std::array<int, 4>>& quads, double width,
               const Vec3& period) {
  std::vector<Edge> border;
  for (const auto& e : border_edges(quads))
    if (!on_seam(patch.node[e.first], patch.node[e.second], period)) border.push_back(e);
  std::map<Edge, Vec3> facet_normal;
  for (const auto& q : quads) {
    const Vec3 n = (patch.node[q[2]] - patch.node[q[0]])
                       .cross(patch.node[q[3]] - patch.node[q[1]])
                       .normalized();
    for (int k = 0; k < 4; ++k) facet_normal[{q[k], q[(k + 1) % 4]}] = n;
  }
  // In the plane of its facet, an edge's outward direction is edge x normal; a corner node has two
  // and goes out by `width` along both.
  std::map<int, Mat3> system;
  std::map<int, Vec3> right;
  for (const auto& e : border) {
    const Vec3 out =
        (patch.node[e.second] - patch.node[e.first]).cross(facet_normal[e]).normalized();
    for (const int n : {e.first, e.second}) {
      if (!system.count(n)) system[n] = Mat3::Zero(), right[n] = Vec3::Zero();
      system[n] += out * out.transpose();
      right[n] += width * out;
    }
  }
  std::map<int, int> outer;
  for (const auto& [n, a] : system) {
    outer[n] = static_cast<int>(patch.node.size());
    patch.master.push_back(n);
    patch.offset.push_back(solve_planes(a, right[n]));
    patch.node.push_back(patch.node[n] + patch.offset.back());
  }
  for (const auto& e : border)
    quads.push_back({e.second, e.first, outer[e.first], outer[e.second]});
}

// Inset of a node: the shortest vector that lies `depth` behind the plane of every facet around it
// (least squares; exact for up to three distinct planes, as on edges and corners of a sleeper).
void inset_nodes(SurfacePatch& patch) {
  const double depth = patch.shell_depth;
  std::vector<Mat3> system(patch.node.size(), Mat3::Zero());
  std::vector<Vec3> right(patch.node.size(), Vec3::Zero());
  for (const auto& t : patch.triangle) {
    const Vec3 n = normal_of(patch.node, t).normalized();
    for (const int i : t) {
      system[i] += n * n.transpose();
      right[i] -= depth * n;
    }
  }
  for (std::size_t i = 0; i < patch.node.size(); ++i)
    patch.inset[i] = solve_planes(system[i], right[i]);
  for (const auto& t : patch.triangle) {
    const Vec3 n = normal_of(patch.node, t).normalized();
    for (const int i : t)
      if (n.dot(patch.inset[i]) > -0.3 * depth)
        throw InputError("surface '" + patch.name + "': folded too sharply for a contact shell");
  }
}

// 6 x volume of a cell, negative where the shell is turned inside out.
double signed_volume(const SurfacePatch& patch, int cell) {
  const std::array<Vec3, 4> v = cell_corners(patch, cell);
  const double six = (v[1] - v[0]).cross(v[2] - v[0]).dot(v[3] - v[0]);
  const auto& t = patch.triangle[cell / 3];  // corners are those of the triangle in rising order
  const bool even = (t[0] < t[1]) + (t[1] < t[2]) + (t[2] < t[0]) == 2;
  const double outside = cell % 3 == 1 ? 1 : -1;  // (a b c c'), (a b b' c'), (a a' b' c')
  return (even ? outside : -outside) * six;
}

void check_cells(const SurfacePatch& patch) {
  for (int k = 0; k < 3 * static_cast<int>(patch.triangle.size()); ++k)
    if (!(signed_volume(patch, k) > 0))
      throw InputError("surface '" + patch.name + "': its facets at an edge are too small for a " +
                       "contact shell of " + std::to_string(1e3 * patch.shell_depth) + " mm");
}

}  // namespace

SurfacePatch make_patch(const std::string& name, int material, const std::vector<Vec3>& nodes,
                        const std::vector<std::array<int, 4>>& quads, double shell_depth,
                        double skirt, const Vec3& period) {
  SurfacePatch patch;
  patch.name = name;
  patch.material = material;
  patch.shell_depth = shell_depth;
  patch.node = nodes;
  patch.carried = static_cast<int>(nodes.size());
  for (int i = 0; i < patch.carried; ++i) patch.master.push_back(i);
  patch.offset.assign(nodes.size(), Vec3::Zero());

  std::vector<std::array<int, 4>> all = quads;
  if (skirt > 0) add_skirt(patch, all, skirt, period);
  for (const auto& q : all) {
    patch.triangle.push_back({q[0], q[1], q[2]});
    patch.triangle.push_back({q[0], q[2], q[3]});
  }
  for (const auto& t : patch.triangle)
    if (!(normal_of(patch.node, t).norm() > 0))
      throw InputError("surface '" + name + "': a facet has no area");

  patch.inset.assign(patch.node.size(), Vec3::Zero());
  inset_nodes(patch);
  check_cells(patch);
  patch.velocity.assign(patch.node.size(), Vec3::Zero());
  patch.force.assign(patch.carried, Vec3::Zero());
  return patch;
}

void move_skirt(SurfacePatch& patch) {
  for (std::size_t i = patch.carried; i < patch.node.size(); ++i) {
    patch.node[i] = patch.node[patch.master[i]] + patch.offset[i];
    patch.velocity[i] = patch.velocity[patch.master[i]];
  }
}

}  // namespace trackbed::dem
