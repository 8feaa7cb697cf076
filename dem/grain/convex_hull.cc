// convex_hull of polyhedron.h: CGAL's hull has exact combinatorics but triangles only; here
// coplanar triangles grow together into faces. The result's topology is checked; should merging
// break it (vertices clustered at the tolerance), the tolerance shrinks until it holds.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polyhedron_3.h>
#include <CGAL/convex_hull_3.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "base/error.h"
#include "dem/grain/polyhedron.h"

namespace trackbed::dem {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Triangle = std::array<int, 3>;
using Edge = std::pair<int, int>;

struct TriangleHull {
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;
};

double extent(const std::vector<Vec3>& points) {
  Vec3 low = points.front(), high = low;
  for (const Vec3& p : points) low = low.cwiseMin(p), high = high.cwiseMax(p);
  return (high - low).norm();
}

bool before(const Vec3& a, const Vec3& b) {
  return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
}

// Without points that lie within `tolerance` of an earlier one (sweep along x).
std::vector<Vec3> without_duplicates(std::vector<Vec3> points, double tolerance) {
  std::sort(points.begin(), points.end(), before);
  std::vector<Vec3> kept;
  for (const Vec3& p : points) {
    bool twin = false;
    for (size_t k = kept.size(); k-- > 0 && p.x() - kept[k].x() <= tolerance && !twin;)
      twin = (p - kept[k]).norm() <= tolerance;
    if (!twin) kept.push_back(p);
  }
  return kept;
}

// `points` are sorted and distinct. CGAL's order of facets changes from run to run (it follows
// addresses); here vertices keep the order of the points and triangles are sorted.
TriangleHull triangle_hull(const std::vector<Vec3>& points) {
  std::vector<Kernel::Point_3> input;
  for (const Vec3& p : points) input.emplace_back(p.x(), p.y(), p.z());
  CGAL::Object result;
  CGAL::convex_hull_3(input.begin(), input.end(), result);
  CGAL::Polyhedron_3<Kernel> solid;
  if (!CGAL::assign(solid, result)) throw InputError("convex hull: the points are coplanar");
  const auto number = [&](const Kernel::Point_3& p) {
    const auto found =
        std::lower_bound(points.begin(), points.end(), Vec3(p.x(), p.y(), p.z()), before);
    return static_cast<int>(found - points.begin());
  };
  TriangleHull hull{points, {}};  // points inside are dropped when faces are made
  for (auto f = solid.facets_begin(); f != solid.facets_end(); ++f) {
    const auto h = f->halfedge();
    Triangle t = {number(h->vertex()->point()), number(h->next()->vertex()->point()),
                  number(h->next()->next()->vertex()->point())};
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    hull.triangles.push_back(t);
  }
  std::sort(hull.triangles.begin(), hull.triangles.end());
  return hull;
}

// Group number of each triangle: groups grow from the largest triangle over neighbours whose
// vertices all lie within `tolerance` of its plane and that face the same way.
std::vector<int> coplanar_groups(const TriangleHull& hull, double tolerance) {
  const int n = static_cast<int>(hull.triangles.size());
  std::vector<Vec3> twice(n);
  std::map<Edge, int> owner;
  for (int t = 0; t < n; ++t) {
    const Triangle& c = hull.triangles[t];
    const Vec3& a = hull.vertices[c[0]];
    twice[t] = (hull.vertices[c[1]] - a).cross(hull.vertices[c[2]] - a);
    for (int k = 0; k < 3; ++k) owner[{c[k], c[(k + 1) % 3]}] = t;
  }
  std::vector<int> order(n), group(n, -1);
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return twice[a].squaredNorm() > twice[b].squaredNorm(); });
  int groups = 0;
  for (int seed : order) {
    if (group[seed] >= 0) continue;
    const Vec3 normal = twice[seed].normalized();
    const double offset = normal.dot(hull.vertices[hull.triangles[seed][0]]);
    std::vector<int> front = {seed};
    group[seed] = groups;
    while (!front.empty()) {
      const Triangle c = hull.triangles[front.back()];
      front.pop_back();
      for (int k = 0; k < 3; ++k) {
        const int next = owner.at({c[(k + 1) % 3], c[k]});
        if (group[next] >= 0) continue;
        double off = 0;
        for (int v : hull.triangles[next])
          off = std::max(off, std::abs(normal.dot(hull.vertices[v]) - offset));
        // A sliver's own normal is noise: its vertices decide.
        const bool same_side = twice[next].dot(normal) >= -1e-6 * twice[seed].norm();
        if (off > tolerance || !same_side) continue;
        group[next] = groups;
        front.push_back(next);
      }
    }
    ++groups;
  }
  return group;
}

// The boundary loop of each group; empty when a group is no disc.
std::vector<std::vector<int>> group_loops(const TriangleHull& hull, const std::vector<int>& group) {
  const int groups = 1 + *std::max_element(group.begin(), group.end());
  std::map<Edge, int> owner;
  for (size_t t = 0; t < group.size(); ++t)
    for (int k = 0; k < 3; ++k)
      owner[{hull.triangles[t][k], hull.triangles[t][(k + 1) % 3]}] = group[t];
  std::vector<std::map<int, int>> next(groups);
  for (const auto& [edge, g] : owner)
    if (owner.at({edge.second, edge.first}) != g)
      if (!next[g].emplace(edge.first, edge.second).second) return {};
  std::vector<std::vector<int>> loops(groups);
  for (int g = 0; g < groups; ++g) {
    if (next[g].empty()) return {};
    const int first = next[g].begin()->first;
    int v = first;
    do {
      loops[g].push_back(v);
      v = next[g].at(v);
    } while (v != first && loops[g].size() <= next[g].size());
    if (loops[g].size() != next[g].size()) return {};
  }
  return loops;
}

// Drops vertices that belong to fewer than three faces; numbers the others anew.
Polyhedron compact(const TriangleHull& hull, const std::vector<std::vector<int>>& loops) {
  std::vector<int> faces_at(hull.vertices.size(), 0), number(hull.vertices.size(), -1);
  for (const auto& loop : loops)
    for (int v : loop) ++faces_at[v];
  Polyhedron body;
  for (size_t v = 0; v < hull.vertices.size(); ++v)
    if (faces_at[v] >= 3) {
      number[v] = static_cast<int>(body.vertices.size());
      body.vertices.push_back(hull.vertices[v]);
    }
  for (const auto& loop : loops) {
    std::vector<int> face;
    for (int v : loop)
      if (number[v] >= 0) face.push_back(number[v]);
    if (!face.empty())
      std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
    body.faces.push_back(face);
  }
  std::sort(body.faces.begin(), body.faces.end());
  return body;
}

bool closed_surface(const Polyhedron& body) {
  std::set<Edge> edges;
  if (body.faces.size() < 4) return false;
  for (const auto& face : body.faces) {
    if (face.size() < 3) return false;
    for (size_t k = 0; k < face.size(); ++k)
      if (!edges.insert({face[k], face[(k + 1) % face.size()]}).second) return false;
  }
  for (const Edge& e : edges)
    if (!edges.count({e.second, e.first})) return false;
  return body.vertices.size() + body.faces.size() == edges.size() / 2 + 2;
}

}  // namespace

Polyhedron convex_hull(const std::vector<Vec3>& points, double share) {
  if (points.size() < 4) throw InputError("convex hull: fewer than 4 points");
  for (const Vec3& p : points)
    if (!p.allFinite()) throw InputError("convex hull: a coordinate is not a finite number");
  const double size = extent(points);
  double tolerance = share * size;
  const std::vector<Vec3> distinct = without_duplicates(points, tolerance);
  if (distinct.size() < 4) throw InputError("convex hull: fewer than 4 distinct points");
  const TriangleHull hull = triangle_hull(distinct);

  double volume = 0, largest = 0;  // six times, twice
  for (const Triangle& t : hull.triangles) {
    const Vec3 a = hull.vertices[t[0]] - distinct[0];
    const Vec3 area = (hull.vertices[t[1]] - hull.vertices[t[0]])
                          .cross(hull.vertices[t[2]] - hull.vertices[t[0]]);
    volume += a.dot(area);
    largest = std::max(largest, area.norm());
  }
  if (!(volume > 10 * tolerance * largest))
    throw InputError("convex hull: the points are coplanar");

  for (; tolerance > 1e-17 * size; tolerance /= 10) {
    const auto loops = group_loops(hull, coplanar_groups(hull, tolerance));
    if (loops.empty()) continue;
    Polyhedron body = compact(hull, loops);
    if (closed_surface(body)) return body;
  }
  std::vector<std::vector<int>> triangles;  // unmerged
  for (const Triangle& t : hull.triangles) triangles.push_back({t[0], t[1], t[2]});
  return compact(hull, triangles);
}

}  // namespace trackbed::dem
