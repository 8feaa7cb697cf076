#include "dem/grain/polyhedron.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "dem/grain/principal_axes.h"
#include "dem/grain/scale_solid.h"

namespace trackbed::dem {
namespace {

Vec3 mean(const std::vector<Vec3>& points) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& p : points) sum += p;
  return points.empty() ? sum : Vec3(sum / double(points.size()));
}

// Moments of the solid about the point o: volume, first and second (int x x^T dV), and the closure
// |sum of area vectors| / sum of areas, which is zero for a closed surface.
struct Moments {
  double volume = 0;
  Vec3 first = Vec3::Zero();
  Mat3 second = Mat3::Zero();
  double open = 0;
};

Moments moments_about(const Polyhedron& body, const Vec3& o) {
  Moments m;
  Vec3 area = Vec3::Zero();
  double surface = 0;
  for (const std::vector<int>& face : body.faces) {
    if (face.size() < 3) throw InputError("polyhedron: a face has fewer than 3 vertices");
    for (int v : face)
      if (v < 0 || v >= static_cast<int>(body.vertices.size()))
        throw InputError("polyhedron: a face names vertex " + std::to_string(v) + " of " +
                         std::to_string(body.vertices.size()));
    const Vec3 a = body.vertices[face[0]] - o;
    for (size_t k = 1; k + 1 < face.size(); ++k) {
      const Vec3 b = body.vertices[face[k]] - o, c = body.vertices[face[k + 1]] - o;
      const Vec3 twice = (b - a).cross(c - a), sum = a + b + c;
      const double det = a.dot(twice);  // six times the signed tetrahedron o, a, b, c
      m.volume += det / 6;
      m.first += det / 24 * sum;
      m.second +=
          det / 120 *
          (a * a.transpose() + b * b.transpose() + c * c.transpose() + sum * sum.transpose());
      area += twice;
      surface += twice.norm();
    }
  }
  m.open = surface > 0 ? area.norm() / surface : 1;
  return m;
}

}  // namespace

MassProperties mass_properties(const Polyhedron& body) {
  for (const Vec3& p : body.vertices)
    if (!p.allFinite()) throw InputError("polyhedron: a coordinate is not a finite number");
  const Vec3 inner = mean(body.vertices);
  const Moments rough = moments_about(body, inner);
  if (!(rough.volume > 0))
    throw InputError("polyhedron: volume is not positive (flat, open or inside-out solid)");
  if (!(rough.open < 1e-6)) throw InputError("polyhedron: the surface is not closed");

  MassProperties p;
  p.volume = rough.volume;
  p.centroid = inner + rough.first / rough.volume;
  // Second moments taken about the centroid itself: no parallel-axis cancellation for slivers.
  const Mat3 c = moments_about(body, p.centroid).second;
  p.inertia = -c;
  for (int i = 0; i < 3; ++i)
    p.inertia(i, i) = c((i + 1) % 3, (i + 1) % 3) + c((i + 2) % 3, (i + 2) % 3);
  p.inertia = (0.5 * (p.inertia + p.inertia.transpose())).eval();
  return p;
}

Polyhedron make_box(const Vec3& edges) {
  if (!(edges.minCoeff() > 0) || !edges.allFinite())
    throw InputError("box: edge lengths must be positive and finite");
  Polyhedron box;
  for (int i = 0; i < 8; ++i)
    box.vertices.push_back(
        0.5 * edges.cwiseProduct(Vec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1)));
  box.faces = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  return box;
}

GrainShape make_grain_shape(const Polyhedron& given) {
  const MassProperties p = mass_properties(given);
  GrainShape shape;
  shape.turn = Quat(principal_axes(p.inertia)).normalized();
  shape.origin = p.centroid;
  shape.body.faces = given.faces;
  const Mat3 back = shape.turn.toRotationMatrix().transpose();
  for (const Vec3& x : given.vertices) {
    const Vec3 local = back * (x - p.centroid);
    shape.body.vertices.push_back(local);
    shape.radius = std::max(shape.radius, local.norm());
  }
  // Moments again in the principal frame: a needle's small moment keeps all its digits.
  const MassProperties own = mass_properties(shape.body);
  shape.volume = own.volume;
  shape.inertia = own.inertia.diagonal();
  return shape;
}

GrainShape scaled(const GrainShape& shape, double factor) {
  GrainShape result = shape;
  scale_solid(result, factor, "grain");
  for (Vec3& v : result.body.vertices) v *= factor;
  for (ConvexPart& part : result.parts) {
    for (Vec3& v : part.core.vertices) v *= factor;
    part.radius *= factor;
    part.crown /= factor;
    part.mean_square *= factor * factor;
  }
  return result;
}

}  // namespace trackbed::dem
