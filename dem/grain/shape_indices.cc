#include "dem/grain/shape_indices.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "base/error.h"
#include "dem/grading/shadow.h"

namespace trackbed::dem {
namespace {

double width_along(const Polyhedron& body, const Vec3& d) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const Vec3& v : body.vertices)
    low = std::min(low, v.dot(d)), high = std::max(high, v.dot(d));
  return high - low;
}

// Calls of(edge vector, area vectors of its two faces) for each edge.
template <class Of>
void for_edges(const Polyhedron& body, const std::vector<Vec3>& areas, Of of) {
  std::map<std::pair<int, int>, int> owner;
  for (int f = 0; f < int(body.faces.size()); ++f) {
    const auto& face = body.faces[f];
    for (size_t k = 0; k < face.size(); ++k) owner[{face[k], face[(k + 1) % face.size()]}] = f;
  }
  for (const auto& [edge, f] : owner)
    if (edge.first < edge.second)
      of(Vec3(body.vertices[edge.second] - body.vertices[edge.first]), areas[f],
         areas[owner.at({edge.second, edge.first})]);
}

// An edge and the directions in which the body ends at it, those between the normals of its faces:
// d . to_a >= 0 and d . to_b >= 0.
struct EdgeCone {
  Vec3 along, to_a, to_b;
  // But for rounding, which may let in more.
  bool holds(const Vec3& d, double size2) const {
    const auto within = [&](double x) { return x >= 0 || x * x <= 1e-18 * size2; };
    return within(d.dot(to_a)) && within(d.dot(to_b));
  }
};

// The least width lies along a face normal or across two edges at which the body ends in opposite
// directions.
double least_width_across_edges(const Polyhedron& body, const std::vector<Vec3>& areas) {
  std::vector<EdgeCone> edges;
  for_edges(body, areas, [&](const Vec3& e, const Vec3& area_a, const Vec3& area_b) {
    const Vec3 a = area_a.normalized(), b = area_b.normalized();
    const EdgeCone cone{e.normalized(), a - a.dot(b) * b, b - a.dot(b) * a};
    if (cone.to_a.norm() > 1e-9) edges.push_back(cone);  // else it lies within a face
  });
  double least = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < edges.size(); ++i)
    for (size_t j = 0; j < i; ++j) {
      const Vec3 d = edges[i].along.cross(edges[j].along);
      const double size2 = d.squaredNorm();
      if (!(size2 > 1e-18)) continue;
      if ((edges[i].holds(d, size2) && edges[j].holds(-d, size2)) ||
          (edges[i].holds(-d, size2) && edges[j].holds(d, size2)))
        least = std::min(least, width_along(body, d.normalized()));
    }
  return least;
}

}  // namespace

double angularity(const Polyhedron& body) {
  double turning = 0, lengths = 0;
  for_edges(body, face_areas(body), [&](const Vec3& e, const Vec3& a, const Vec3& b) {
    turning += e.norm() * std::atan2(a.cross(b).norm(), a.dot(b));
    lengths += e.norm();
  });
  return turning / lengths / std::acos(0.0);
}

ShapeIndices shape_indices(const Polyhedron& body) {
  ShapeIndices s;
  const double volume = mass_properties(body).volume;
  const std::vector<Vec3> areas = face_areas(body);

  double least_volume = std::numeric_limits<double>::infinity();
  s.width = least_volume;
  for (const Vec3& area : areas) {
    s.surface += area.norm();
    if (area.norm() == 0) continue;
    const Vec3 n = area.normalized();
    const double height = width_along(body, n);
    s.width = std::min(s.width, height);
    const Rectangle r = least_rectangle(shadow(body, n));
    if (height * r.p * r.q >= least_volume) continue;
    least_volume = height * r.p * r.q;
    double edges[3] = {height, r.p, r.q};
    std::sort(edges, edges + 3);
    s.length = edges[2], s.intermediate = edges[1], s.shortest = edges[0];
  }
  s.elongation = s.intermediate / s.length;
  s.flatness = s.shortest / s.intermediate;

  s.angularity = angularity(body);
  s.width = std::min(s.width, least_width_across_edges(body, areas));
  for (const Vec3& p : body.vertices)
    for (const Vec3& q : body.vertices) s.diameter = std::max(s.diameter, (p - q).norm());
  s.sphericity = std::cbrt(36 * M_PI * volume * volume) / s.surface;
  return s;
}

LibraryIndices library_indices(const std::vector<GrainShape>& shapes,
                               const std::vector<ShapeIndices>& indices) {
  LibraryIndices r;
  double total = 0;
  for (size_t k = 0; k < shapes.size(); ++k) {
    const GrainShape& shape = shapes[k];
    const ShapeIndices& s = indices.at(k);
    if (!(shape.sieve_size > 0)) throw InputError("shape indices: a grain is not sized");
    total += shape.volume;
    if (s.width < 0.6 * shape.sieve_size) r.flaky += shape.volume;
    if (s.diameter > 1.8 * shape.sieve_size) r.elongated += shape.volume;
    if (s.diameter > 3 * s.width) r.slender += shape.volume;
  }
  if (!(total > 0)) throw InputError("shape indices: no grains");
  r.flaky *= 100 / total, r.elongated *= 100 / total, r.slender *= 100 / total;
  return r;
}

}  // namespace trackbed::dem
