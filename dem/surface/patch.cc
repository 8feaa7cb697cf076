#include "dem/surface/patch.h"

#include <cmath>
#include <map>

#include "base/error.h"

namespace trackbed::dem {
namespace {

Vec3 normal_of(const std::vector<Vec3>& x, const std::array<int, 3>& t) {
  return (x[t[1]] - x[t[0]]).cross(x[t[2]] - x[t[0]]);
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
      if (!system.count(n)) system[n] = 1e-9 * Mat3::Identity(), right[n] = Vec3::Zero();
      system[n] += out * out.transpose();
      right[n] += width * out;
    }
  }
  std::map<int, int> outer;
  for (const auto& [n, a] : system) {
    outer[n] = static_cast<int>(patch.node.size());
    patch.master.push_back(n);
    patch.offset.push_back(a.ldlt().solve(right[n]));
    patch.node.push_back(patch.node[n] + patch.offset.back());
  }
  for (const auto& e : border)
    quads.push_back({e.second, e.first, outer[e.first], outer[e.second]});
}

// Inset of a node: the shortest vector that lies `depth` behind the plane of every facet around it
// (least squares; exact for up to three distinct planes, as on edges and corners of a sleeper).
void inset_nodes(SurfacePatch& patch) {
  const double depth = patch.shell_depth;
  std::vector<Mat3> system(patch.node.size(), 1e-9 * Mat3::Identity());
  std::vector<Vec3> right(patch.node.size(), Vec3::Zero());
  for (const auto& t : patch.triangle) {
    const Vec3 n = normal_of(patch.node, t).normalized();
    for (const int i : t) {
      system[i] += n * n.transpose();
      right[i] -= depth * n;
    }
  }
  for (std::size_t i = 0; i < patch.node.size(); ++i)
    patch.inset[i] = system[i].ldlt().solve(right[i]);
  for (const auto& t : patch.triangle) {
    const Vec3 n = normal_of(patch.node, t).normalized();
    for (const int i : t)
      if (n.dot(patch.inset[i]) > -0.3 * depth)
        throw InputError("surface '" + patch.name + "': folded too sharply for a contact shell");
  }
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
