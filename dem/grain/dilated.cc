#include "dem/grain/dilated.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "base/error.h"

namespace trackbed::dem {
namespace {

struct Edge {
  int from, to;     // vertices, along the left face
  int left, right;  // faces
  Vec3 direction;   // unit
  double length;
  double turn;  // exterior angle, from the left to the right face's normal
};

struct Surface {
  std::vector<double> area;
  std::vector<Vec3> normal;
  std::vector<Edge> edges;
};

Surface surface_of(const Polyhedron& body) {
  Surface s;
  std::map<std::pair<int, int>, int> owner;
  for (int f = 0; f < int(body.faces.size()); ++f) {
    const auto& face = body.faces[f];
    Vec3 twice = Vec3::Zero();
    const Vec3& a = body.vertices[face[0]];
    for (size_t k = 0; k < face.size(); ++k) {
      owner[{face[k], face[(k + 1) % face.size()]}] = f;
      if (k + 1 < face.size())
        twice += (body.vertices[face[k]] - a).cross(body.vertices[face[k + 1]] - a);
    }
    s.area.push_back(0.5 * twice.norm());
    s.normal.push_back(twice.normalized());
  }
  for (const auto& [edge, left] : owner) {
    if (edge.first > edge.second) continue;
    const auto other = owner.find({edge.second, edge.first});
    if (other == owner.end()) throw InputError("dilated polyhedron: the surface is not closed");
    const Vec3 e = body.vertices[edge.second] - body.vertices[edge.first];
    const Vec3 &n = s.normal[left], &m = s.normal[other->second];
    const double turn = std::atan2(n.cross(m).dot(e.normalized()), n.dot(m));
    s.edges.push_back(
        {edge.first, edge.second, left, other->second, e.normalized(), e.norm(), std::abs(turn)});
  }
  return s;
}

// Integrals of 1, x and x x' over a piece.
struct Integrals {
  double volume = 0;
  Vec3 first = Vec3::Zero();
  Mat3 second = Mat3::Zero();
};
Mat3 both_ways(const Vec3& a, const Vec3& b) { return a * b.transpose() + b * a.transpose(); }

// Of a polygon, coordinates relative to o.
Integrals face_integrals(const Polyhedron& body, const std::vector<int>& face, const Vec3& o) {
  Integrals i;
  const Vec3 a = body.vertices[face[0]] - o;
  for (size_t k = 1; k + 1 < face.size(); ++k) {
    const Vec3 b = body.vertices[face[k]] - o, c = body.vertices[face[k + 1]] - o, sum = a + b + c;
    const double area = 0.5 * (b - a).cross(c - a).norm();
    i.volume += area;
    i.first += area / 3 * sum;
    i.second += area / 12 *
                (a * a.transpose() + b * b.transpose() + c * c.transpose() + sum * sum.transpose());
  }
  return i;
}

void add_core(Integrals& sum, const Polyhedron& body, const Vec3& o) {
  for (const auto& face : body.faces) {
    const Vec3 a = body.vertices[face[0]] - o;
    for (size_t k = 1; k + 1 < face.size(); ++k) {
      const Vec3 b = body.vertices[face[k]] - o, c = body.vertices[face[k + 1]] - o;
      const Vec3 all = a + b + c;
      const double det = a.dot(b.cross(c));
      sum.volume += det / 6;
      sum.first += det / 24 * all;
      sum.second +=
          det / 120 *
          (a * a.transpose() + b * b.transpose() + c * c.transpose() + all * all.transpose());
    }
  }
}

void add_prism(Integrals& sum, const Integrals& face, const Vec3& n, double r) {
  sum.volume += r * face.volume;
  sum.first += r * face.first + r * r / 2 * face.volume * n;
  sum.second += r * face.second + r * r / 2 * both_ways(face.first, n) +
                r * r * r / 3 * face.volume * n * n.transpose();
}

void add_edge(Integrals& sum, const Polyhedron& body, const Edge& edge, const Vec3& n,
              const Vec3& o, double r) {
  const Vec3 a = body.vertices[edge.from] - o, b = body.vertices[edge.to] - o;
  const Vec3 line = edge.length / 2 * (a + b);
  const Mat3 line2 =
      edge.length / 6 * (2 * a * a.transpose() + 2 * b * b.transpose() + both_ways(a, b));
  const double t = edge.turn, s = std::sin(t), half = std::sin(t / 2);
  const Vec3 q = edge.direction.cross(n);  // the normal turns from n towards q
  const Vec3 m = s * n + 2 * half * half * q;
  const Mat3 mm = (t / 2 + std::sin(2 * t) / 4) * n * n.transpose() +
                  (t / 2 - std::sin(2 * t) / 4) * q * q.transpose() + s * s / 2 * both_ways(n, q);
  sum.volume += edge.length * t * r * r / 2;
  sum.first += t * r * r / 2 * line + edge.length * r * r * r / 3 * m;
  sum.second += t * r * r / 2 * line2 + r * r * r / 3 * both_ways(line, m) +
                r * r * r * r / 4 * edge.length * mm;
}

// Integrals of 1 and m over the normal cone of one vertex, a spherical polygon whose sides are the
// arcs of its edges: <m> = sum t b / 2, b the inward normal of a side's plane (the edge's
// direction). <m m'> is needed of all cones together only: they fill the sphere, 4/3 pi 1.
struct Cone {
  double angle = 0;
  Vec3 first = Vec3::Zero();
};

std::vector<Cone> normal_cones(const Polyhedron& body, const Surface& s) {
  std::vector<Cone> cones(body.vertices.size());
  std::vector<Vec3> middle(body.vertices.size(), Vec3::Zero());
  for (size_t f = 0; f < body.faces.size(); ++f)
    for (int v : body.faces[f]) middle[v] += s.normal[f];
  for (const Edge& edge : s.edges) {
    const Vec3 &n = s.normal[edge.left], &m = s.normal[edge.right];
    for (int end = 0; end < 2; ++end) {
      const int v = end ? edge.to : edge.from;
      // Seen from outside, the arc runs from n to m anticlockwise about the edge's far end.
      const Vec3 inward = end ? edge.direction : Vec3(-edge.direction);
      const Vec3 &a = end ? n : m, &b = end ? m : n, c = middle[v].normalized();
      Cone& cone = cones[v];
      cone.angle += 2 * std::atan2(c.dot(a.cross(b)), 1 + a.dot(b) + b.dot(c) + c.dot(a));
      cone.first += edge.turn / 2 * inward;
    }
  }
  return cones;
}

void add_vertex(Integrals& sum, const Cone& cone, const Vec3& p, double r) {
  const double r3 = r * r * r;
  sum.volume += r3 / 3 * cone.angle;
  sum.first += r3 / 3 * cone.angle * p + r3 * r / 4 * cone.first;
  sum.second += r3 / 3 * cone.angle * p * p.transpose() + r3 * r / 4 * both_ways(p, cone.first);
}

Integrals integrals(const DilatedPolyhedron& body, const Surface& s, const Vec3& o) {
  Integrals sum;
  add_core(sum, body.core, o);
  if (body.radius == 0) return sum;
  for (size_t f = 0; f < s.area.size(); ++f)
    add_prism(sum, face_integrals(body.core, body.core.faces[f], o), s.normal[f], body.radius);
  for (const Edge& edge : s.edges)
    add_edge(sum, body.core, edge, s.normal[edge.left], o, body.radius);
  const auto cones = normal_cones(body.core, s);
  for (size_t v = 0; v < cones.size(); ++v)
    add_vertex(sum, cones[v], body.core.vertices[v] - o, body.radius);
  sum.second += 4 * M_PI / 15 * std::pow(body.radius, 5) * Mat3::Identity();
  return sum;
}

void check(const DilatedPolyhedron& body) {
  if (!(body.radius >= 0) || !std::isfinite(body.radius))
    throw InputError("dilated polyhedron: the radius must be finite and not negative");
}

}  // namespace

double mean_curvature(const Polyhedron& body) {
  double sum = 0;
  for (const Edge& edge : surface_of(body).edges) sum += 0.5 * edge.length * edge.turn;
  return sum;
}

double dilated_volume(const DilatedPolyhedron& body) {
  check(body);
  const double r = body.radius;
  double surface = 0;
  for (double area : surface_of(body.core).area) surface += area;
  return mass_properties(body.core).volume +
         r * (surface + r * (mean_curvature(body.core) + r * 4 / 3 * M_PI));
}

MassProperties mass_properties(const DilatedPolyhedron& body) {
  check(body);
  const MassProperties core = mass_properties(body.core);  // throws when it is no solid
  const Surface s = surface_of(body.core);
  const Integrals rough = integrals(body, s, core.centroid);
  MassProperties p;
  p.volume = rough.volume;
  p.centroid = core.centroid + rough.first / rough.volume;
  const Mat3 c = integrals(body, s, p.centroid).second;
  p.inertia = -0.5 * (c + c.transpose());
  for (int i = 0; i < 3; ++i)
    p.inertia(i, i) = c((i + 1) % 3, (i + 1) % 3) + c((i + 2) % 3, (i + 2) % 3);
  return p;
}

}  // namespace trackbed::dem
