#include "dem/grain/voronoi.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <string>

#include "base/error.h"
#include "dem/grain/random.h"

namespace trackbed::dem {
namespace {

// Points in a periodic cube, sorted into cells of edge >= 1 (the mean Voronoi cell's edge).
class PeriodicGrid {
 public:
  explicit PeriodicGrid(double edge)
      : edge_(edge), n_(std::max(1, int(edge))), cell_(n_ * n_ * n_) {}
  double edge() const { return edge_; }
  const std::vector<Vec3>& points() const { return points_; }

  void insert(const Vec3& p) {
    cell_[index(at(p.x()), at(p.y()), at(p.z()))].push_back(int(points_.size()));
    points_.push_back(p);
  }

  // Vectors from p to all points (and images) within `reach`, without p itself.
  void neighbours(const Vec3& p, double reach, std::vector<Vec3>& vectors) const {
    vectors.clear();
    const double width = edge_ / n_;
    const int r = int(std::ceil(reach / width));
    const int ci[3] = {at(p.x()), at(p.y()), at(p.z())};
    for (int i = ci[0] - r; i <= ci[0] + r; ++i)
      for (int j = ci[1] - r; j <= ci[1] + r; ++j)
        for (int k = ci[2] - r; k <= ci[2] + r; ++k) {
          const Vec3 image = edge_ * Vec3(wraps(i), wraps(j), wraps(k));
          for (int q : cell_[index(i - n_ * wraps(i), j - n_ * wraps(j), k - n_ * wraps(k))]) {
            const Vec3 d = points_[q] + image - p;
            const double r2 = d.squaredNorm();
            if (r2 > 0 && r2 <= reach * reach) vectors.push_back(d);
          }
        }
  }

 private:
  int at(double x) const { return std::min(n_ - 1, int(x / edge_ * n_)); }
  int wraps(int i) const { return i >= 0 ? i / n_ : -((n_ - 1 - i) / n_); }
  int index(int i, int j, int k) const { return (i * n_ + j) * n_ + k; }
  double edge_;
  int n_;
  std::vector<std::vector<int>> cell_;
  std::vector<Vec3> points_;
};

PeriodicGrid seed_points(const VoronoiParameters& p) {
  Random random(p.seed);
  PeriodicGrid grid(std::cbrt(double(p.count)));
  std::vector<Vec3> near;
  double spacing = p.spacing;
  for (int refused = 0; int(grid.points().size()) < p.count;) {
    const double x = random.uniform(), y = random.uniform(), z = random.uniform();
    const Vec3 candidate = grid.edge() * Vec3(x, y, z);
    grid.neighbours(candidate, spacing, near);
    if (near.empty()) {
      grid.insert(candidate);
      refused = 0;
    } else if (++refused > 2000) {  // jammed: give way a little
      spacing *= 0.98;
      refused = 0;
    }
  }
  return grid;
}

double face_area(const Polyhedron& body, const std::vector<int>& face) {
  Vec3 twice = Vec3::Zero();
  const Vec3& a = body.vertices[face[0]];
  for (size_t k = 1; k + 1 < face.size(); ++k)
    twice += (body.vertices[face[k]] - a).cross(body.vertices[face[k + 1]] - a);
  return 0.5 * twice.norm();
}

// The least face if it is below `share` of the mean face, else -1.
int least_face(const Polyhedron& body, double share) {
  double total = 0, least = 0;
  int which = -1;
  for (size_t f = 0; f < body.faces.size(); ++f) {
    const double area = face_area(body, body.faces[f]);
    total += area;
    if (which < 0 || area < least) least = area, which = int(f);
  }
  return least < share * total / double(body.faces.size()) ? which : -1;
}

// Leaves out the plane of the least face, one after the other.
Polyhedron without_small_faces(Polyhedron body, double share) {
  while (body.faces.size() > 6) {
    const int drop = least_face(body, share);
    if (drop < 0) break;
    std::vector<Vec3> normals;
    std::vector<double> offsets;
    for (int f = 0; f < int(body.faces.size()); ++f) {
      if (f == drop) continue;
      const auto& face = body.faces[f];
      Vec3 n = Vec3::Zero(), middle = Vec3::Zero();
      for (size_t k = 0; k < face.size(); ++k) {
        n += body.vertices[face[k]].cross(body.vertices[face[(k + 1) % face.size()]]);
        middle += body.vertices[face[k]] / double(face.size());
      }
      normals.push_back(n.normalized());
      offsets.push_back(normals.back().dot(middle));
    }
    Polyhedron next;
    try {
      next = intersect_half_spaces(normals, offsets);
    } catch (const InputError&) {
      break;  // unbounded without that face
    }
    double reach = 0, reach_next = 0;
    for (const Vec3& v : body.vertices) reach = std::max(reach, v.norm());
    for (const Vec3& v : next.vertices) reach_next = std::max(reach_next, v.norm());
    if (reach_next > 1.15 * reach) break;  // would grow a spike
    body = std::move(next);
  }
  return body;
}

Polyhedron cell(const PeriodicGrid& grid, const Vec3& p) {
  std::vector<Vec3> vectors, normals;
  std::vector<double> offsets;
  for (double reach = 2.2;; reach *= 1.5) {
    grid.neighbours(p, reach, vectors);
    normals.clear(), offsets.clear();
    for (const Vec3& n : vectors) {
      normals.push_back(n);
      offsets.push_back(0.5 * n.squaredNorm());
    }
    // A cube far outside bounds the cell while too few neighbours are known.
    for (int axis = 0; axis < 3; ++axis)
      for (int sign : {-1, 1}) {
        normals.push_back(sign * Vec3::Unit(axis));
        offsets.push_back(10 * reach);
      }
    Polyhedron body = intersect_half_spaces(normals, offsets);
    double farthest = 0;
    for (const Vec3& v : body.vertices) farthest = std::max(farthest, v.norm());
    if (2 * farthest <= reach) return body;  // no point beyond the reach can cut it
  }
}

}  // namespace

Polyhedron intersect_half_spaces(const std::vector<Vec3>& normals,
                                 const std::vector<double>& offsets) {
  std::vector<Vec3> dual;
  for (size_t i = 0; i < normals.size(); ++i) {
    if (!(offsets[i] > 0)) throw InputError("half-spaces: the origin is not inside");
    dual.push_back(normals[i] / offsets[i]);
  }
  const Polyhedron hull = convex_hull(dual);
  std::vector<Vec3> corners;
  for (const auto& face : hull.faces) {
    Vec3 n = Vec3::Zero();
    const Vec3& a = hull.vertices[face[0]];
    for (size_t k = 1; k + 1 < face.size(); ++k)
      n += (hull.vertices[face[k]] - a).cross(hull.vertices[face[k + 1]] - a);
    n.normalize();
    double offset = n.dot(a);
    if (!(offset > 1e-9 * a.norm())) throw InputError("half-spaces: the body is unbounded");
    corners.push_back(n / offset);
  }
  return convex_hull(corners);
}

std::vector<Polyhedron> voronoi_grains(const VoronoiParameters& p) {
  if (p.count < 1) throw InputError("Voronoi grains: count must be at least 1");
  if (!(p.spacing >= 0 && p.spacing <= 0.8))
    throw InputError("Voronoi grains: spacing must lie in [0, 0.8]");
  if (!(p.least_face >= 0 && p.least_face < 1))
    throw InputError("Voronoi grains: least_face must lie in [0, 1)");
  const PeriodicGrid grid = seed_points(p);
  std::vector<Polyhedron> grains(p.count);
  std::exception_ptr failure;
  int failed = p.count;
#pragma omp parallel for schedule(dynamic, 16)
  for (int i = 0; i < p.count; ++i) {
    try {
      grains[i] = without_small_faces(cell(grid, grid.points()[i]), p.least_face);
    } catch (...) {
#pragma omp critical
      if (i < failed) failed = i, failure = std::current_exception();
    }
  }
  if (failure) std::rethrow_exception(failure);
  return grains;
}

std::vector<Polyhedron> ellipsoid_grains(const EllipsoidParameters& p) {
  if (p.count < 1) throw InputError("ellipsoid grains: count must be at least 1");
  if (p.points_least < 4 || p.points_most < p.points_least)
    throw InputError("ellipsoid grains: points must satisfy 4 <= least <= most");
  if (!(p.axes.minCoeff() > 0) || !p.axes.allFinite())
    throw InputError("ellipsoid grains: axes must be positive");
  Random random(p.seed);
  std::vector<Polyhedron> grains;
  while (int(grains.size()) < p.count) {
    const int wanted = p.points_least + int(random.below(p.points_most - p.points_least + 1));
    std::vector<Vec3> sphere;
    double apart = std::sqrt(8.0 / wanted);  // of the order of the densest packing's distance
    for (int refused = 0; int(sphere.size()) < wanted;) {
      const Vec3 d = random.direction();
      const bool free = std::all_of(sphere.begin(), sphere.end(), [&](const Vec3& s) {
        return (s - d).squaredNorm() >= apart * apart;
      });
      if (free) sphere.push_back(d);
      if (!free && ++refused % 50 == 0) apart *= 0.95;
    }
    std::vector<Vec3> points;
    Vec3 middle = Vec3::Zero();
    for (const Vec3& s : sphere) {
      points.push_back(0.5 * p.axes.cwiseProduct(s));
      middle += s / wanted;
    }
    if (middle.norm() < 0.5) grains.push_back(convex_hull(points));  // else: lopsided, try again
  }
  return grains;
}

}  // namespace trackbed::dem
