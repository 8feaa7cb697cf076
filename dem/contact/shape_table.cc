#include "dem/contact/shape_table.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include "base/error.h"

namespace trackbed::dem {
namespace {

constexpr int kPad = 8;  // doubles of one 512-bit register

struct Plane {
  Vec3 normal;
  double offset;
};

// Newell's vector area about the face's first vertex; the plane passes through the vertices' mean.
Plane plane_of(const Polyhedron& body, const std::vector<int>& face) {
  Vec3 area = Vec3::Zero(), mean = Vec3::Zero();
  const Vec3& origin = body.vertices[face[0]];
  for (std::size_t k = 0; k < face.size(); ++k) {
    const Vec3& p = body.vertices[face[k]];
    const Vec3& q = body.vertices[face[(k + 1) % face.size()]];
    area += (p - origin).cross(q - origin);
    mean += p - origin;
  }
  const double size = area.norm();
  if (!(size > 0)) throw InputError("shape: a face has no area");
  const Vec3 normal = area / size;
  return {normal, normal.dot(origin) + normal.dot(mean) / double(face.size())};
}

}  // namespace

int ShapeTable::add(const GrainShape& shape) {
  const Polyhedron& body = shape.body;
  const int n = static_cast<int>(body.vertices.size());
  const int faces = static_cast<int>(body.faces.size());
  if (n < 4 || faces < 4) throw InputError("shape: a polyhedron needs 4 vertices and 4 faces");
  std::size_t corners = 0;
  for (const auto& face : body.faces) corners += face.size();
  if (n > 65535 || corners > 65535)
    throw InputError("shape: more than 65535 vertices: " + std::to_string(n));

  std::vector<Plane> planes;
  std::vector<std::set<int>> neighbors(n);
  for (const auto& face : body.faces) {
    if (face.size() < 3) throw InputError("shape: a face has fewer than 3 vertices");
    for (int v : face)
      if (v < 0 || v >= n) throw InputError("shape: a face names a vertex that does not exist");
    planes.push_back(plane_of(body, face));
    for (std::size_t k = 0; k < face.size(); ++k)
      neighbors[face[k]].insert(face[(k + 1) % face.size()]);
  }
  for (int v = 0; v < n; ++v)
    for (int w : neighbors[v])
      if (!neighbors[w].count(v)) throw InputError("shape: an edge belongs to one face only");

  Begin b;
  b.vertex = static_cast<int>(x_.size());
  b.vertices = n;
  b.padded = (n + kPad - 1) / kPad * kPad;
  b.face = static_cast<int>(nx_.size());
  b.faces = faces;
  b.loop_begin = static_cast<int>(loop_begin_.size());
  b.loop = static_cast<int>(loop_.size());
  b.neighbor_begin = static_cast<int>(neighbor_begin_.size());
  b.neighbor = static_cast<int>(neighbor_.size());
  b.bits = static_cast<int>(vertex_faces_.size());
  b.words = (faces + 63) / 64;
  begin_.push_back(b);

  for (int v = 0; v < b.padded; ++v) {
    const Vec3& p = body.vertices[std::min(v, n - 1)];
    x_.push_back(p.x());
    y_.push_back(p.y());
    z_.push_back(p.z());
  }
  vertex_faces_.resize(vertex_faces_.size() + std::size_t(n) * b.words, 0);
  std::uint64_t* bits = vertex_faces_.data() + b.bits;
  int loop_end = 0;
  for (int f = 0; f < faces; ++f) {
    nx_.push_back(planes[f].normal.x());
    ny_.push_back(planes[f].normal.y());
    nz_.push_back(planes[f].normal.z());
    offset_.push_back(planes[f].offset);
    loop_begin_.push_back(static_cast<std::uint16_t>(loop_end));
    for (int v : body.faces[f]) {
      loop_.push_back(static_cast<std::uint16_t>(v));
      bits[v * b.words + f / 64] |= std::uint64_t(1) << (f % 64);
      ++loop_end;
    }
  }
  loop_begin_.push_back(static_cast<std::uint16_t>(loop_end));
  int neighbor_end = 0;
  for (int v = 0; v < n; ++v) {
    neighbor_begin_.push_back(static_cast<std::uint16_t>(neighbor_end));
    for (int w : neighbors[v]) {
      neighbor_.push_back(static_cast<std::uint16_t>(w));
      ++neighbor_end;
    }
  }
  neighbor_begin_.push_back(static_cast<std::uint16_t>(neighbor_end));
  shapes_.push_back(shape);
  return size() - 1;
}

ConvexView ShapeTable::view(int s) const {
  const Begin& b = begin_[s];
  ConvexView v;
  v.x = x_.data() + b.vertex;
  v.y = y_.data() + b.vertex;
  v.z = z_.data() + b.vertex;
  v.vertices = b.vertices;
  v.padded = b.padded;
  v.nx = nx_.data() + b.face;
  v.ny = ny_.data() + b.face;
  v.nz = nz_.data() + b.face;
  v.offset = offset_.data() + b.face;
  v.faces = b.faces;
  v.loop_begin = loop_begin_.data() + b.loop_begin;
  v.loop = loop_.data() + b.loop;
  v.radius = shapes_[s].radius;
  v.neighbor_begin = neighbor_begin_.data() + b.neighbor_begin;
  v.neighbor = neighbor_.data() + b.neighbor;
  v.vertex_faces = vertex_faces_.data() + b.bits;
  v.face_words = b.words;
  return v;
}

}  // namespace trackbed::dem
