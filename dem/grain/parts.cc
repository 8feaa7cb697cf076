#include "dem/grain/parts.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "dem/grain/principal_axes.h"

namespace trackbed::dem {
namespace {

std::vector<Vec3> icosahedron() {
  const double g = (1 + std::sqrt(5.0)) / 2;
  std::vector<Vec3> v;
  for (const double a : {-1., 1.})
    for (const double b : {-g, g})
      v.push_back(Vec3(0, a, b)), v.push_back(Vec3(a, b, 0)), v.push_back(Vec3(b, 0, a));
  for (Vec3& p : v) p.normalize();
  return v;
}

// The icosahedron's vertices and the middles of its edges, on the unit sphere.
std::vector<Vec3> sphere_directions() {
  std::vector<Vec3> v = icosahedron();
  const std::size_t n = v.size();
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i + 1; j < n; ++j)
      if (v[i].dot(v[j]) > 0.4) v.push_back((v[i] + v[j]).normalized());
  return v;
}

// Distance of the nearest face from the origin.
double inner_radius(const Polyhedron& body) {
  double least = HUGE_VAL;
  for (const auto& f : body.faces) {
    const Vec3 n = (body.vertices[f[1]] - body.vertices[f[0]])
                       .cross(body.vertices[f[2]] - body.vertices[f[0]])
                       .normalized();
    least = std::min(least, n.dot(body.vertices[f[0]]));
  }
  return least;
}

const Polyhedron& around_unit_sphere() {
  static const Polyhedron body = [] {
    Polyhedron p = convex_hull(sphere_directions());
    const double r = inner_radius(p);
    for (Vec3& v : p.vertices) v /= r;
    return p;
  }();
  return body;
}

ConvexPart ball(const Sphere& s) {
  ConvexPart part;
  part.core.vertices = {s.centre};
  part.radius = s.radius;
  return part;
}

struct FaceMoments {
  Vec3 normal;
  double area = 0, square = 0;  // int |x|^2 dA
};

FaceMoments moments(const Polyhedron& p, const std::vector<int>& face) {
  FaceMoments m;
  Vec3 sum = Vec3::Zero();
  for (std::size_t k = 2; k < face.size(); ++k) {
    const Vec3 &a = p.vertices[face[0]], &b = p.vertices[face[k - 1]], &c = p.vertices[face[k]];
    const Vec3 area = (b - a).cross(c - a) / 2;
    sum += area;
    m.area += area.norm();
    m.square += area.norm() / 12 *
                (a.squaredNorm() + b.squaredNorm() + c.squaredNorm() + (a + b + c).squaredNorm());
  }
  m.normal = sum.normalized();
  return m;
}

// Of the core dilated by its radius: hull of the vertices pushed along the normals of their faces,
// of the edges between them and of the vertex itself, a little further so that the rounding lies
// inside.
Polyhedron around_dilated(const ConvexPart& part) {
  const Polyhedron& core = part.core;
  std::vector<std::vector<Vec3>> normals(core.vertices.size());
  for (const auto& face : core.faces) {
    const Vec3 n = moments(core, face).normal;
    for (const int v : face) normals[v].push_back(n);
  }
  std::vector<Vec3> points;
  for (std::size_t v = 0; v < normals.size(); ++v) {
    Vec3 sum = Vec3::Zero();
    for (const Vec3& n : normals[v]) sum += n;
    std::vector<Vec3> directions = normals[v];
    for (const Vec3& a : normals[v])
      for (const Vec3& b : normals[v])
        if (a.dot(b) < 1 && (a + b).norm() > 1e-3) directions.push_back((a + b).normalized());
    if (sum.norm() > 1e-3) directions.push_back(sum.normalized());
    for (const Vec3& n : directions) points.push_back(core.vertices[v] + 1.08 * part.radius * n);
  }
  return convex_hull(points);
}

void append(const Polyhedron& piece, const Vec3& at, double scale, Polyhedron& all) {
  const int base = static_cast<int>(all.vertices.size());
  for (const Vec3& v : piece.vertices) all.vertices.push_back(at + scale * v);
  for (std::vector<int> face : piece.faces) {
    for (int& v : face) v += base;
    all.faces.push_back(std::move(face));
  }
}

}  // namespace

Polyhedron polyhedron_around_sphere(double radius) {
  Polyhedron p = around_unit_sphere();
  for (Vec3& v : p.vertices) v *= radius;
  return p;
}

GrainShape sphere_shape(double radius) {
  if (!(radius > 0) || !std::isfinite(radius))
    throw InputError("sphere: the radius must be positive and finite");
  GrainShape s;
  s.body = polyhedron_around_sphere(radius);
  s.parts = {ball({Vec3::Zero(), radius})};
  s.volume = 4. / 3 * M_PI * radius * radius * radius;
  s.inertia = Vec3::Constant(0.4 * s.volume * radius * radius);
  s.radius = radius;
  s.sieve_size = 2 * radius;
  return s;
}

GrainShape as_grain(const ClumpShape& c) {
  GrainShape s;
  std::vector<Vec3> points;
  for (const Sphere& sphere : c.spheres) {
    s.parts.push_back(ball(sphere));
    for (const Vec3& v : around_unit_sphere().vertices)
      points.push_back(sphere.centre + sphere.radius * v);
  }
  s.body = convex_hull(points);
  s.volume = c.volume, s.inertia = c.inertia, s.radius = c.radius, s.sieve_size = c.sieve_size;
  s.origin = c.origin, s.turn = c.turn;
  return s;
}

GrainShape as_grain(const DilatedShape& d, double crown_share) {
  if (!(d.body.radius > 0)) throw InputError("dilated grain: the radius must be positive");
  ConvexPart part;
  part.core = d.body.core;
  part.radius = d.body.radius;
  double area = 0, square = 0, most = 0;
  for (const auto& face : part.core.faces) {
    const FaceMoments m = moments(part.core, face);
    area += m.area, square += m.square;
  }
  for (const Vec3& v : part.core.vertices) most = std::max(most, v.squaredNorm());
  part.mean_square = square / area;
  // At a corner the radius keeps at least three quarters.
  part.crown = std::min(crown_share / std::sqrt(most), part.radius / 2 / (most - part.mean_square));
  GrainShape s;
  s.parts = {part};
  s.body = around_dilated(part);
  s.volume = d.volume, s.inertia = d.inertia, s.radius = d.radius, s.sieve_size = d.sieve_size;
  s.origin = d.origin, s.turn = d.turn;
  return s;
}

GrainShape union_shape(const std::vector<Polyhedron>& given) {
  if (given.empty()) throw InputError("union of polyhedra: there is none");
  MassProperties all;
  std::vector<MassProperties> each;
  for (const Polyhedron& p : given) {
    each.push_back(mass_properties(p));
    all.volume += each.back().volume;
    all.centroid += each.back().volume * each.back().centroid;
  }
  all.centroid /= all.volume;
  for (const MassProperties& m : each) {
    const Vec3 d = m.centroid - all.centroid;
    all.inertia += m.inertia + m.volume * (d.squaredNorm() * Mat3::Identity() - d * d.transpose());
  }
  GrainShape s;
  s.turn = Quat(principal_axes(all.inertia)).normalized();
  s.origin = all.centroid;
  const Mat3 back = s.turn.toRotationMatrix().transpose();
  std::vector<Vec3> points;
  for (const Polyhedron& p : given) {
    ConvexPart part;
    part.core = p;
    for (Vec3& v : part.core.vertices) {
      v = (back * (v - s.origin)).eval();
      points.push_back(v);
      s.radius = std::max(s.radius, v.norm());
    }
    s.parts.push_back(part);
  }
  s.body = convex_hull(points);
  s.volume = all.volume;
  s.inertia = (back * all.inertia * back.transpose()).diagonal();
  return s;
}

Polyhedron drawing(const GrainShape& s) {
  if (s.parts.empty()) return s.body;
  Polyhedron all;
  for (const ConvexPart& part : s.parts) {
    if (part.core.faces.empty())
      append(around_unit_sphere(), part.core.vertices[0], part.radius, all);
    else if (part.radius > 0)
      append(s.body, Vec3::Zero(), 1, all);
    else
      append(part.core, Vec3::Zero(), 1, all);
  }
  return all;
}

}  // namespace trackbed::dem
