#include "dem/contact/shape_table.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

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

// A face at a vertex: its loop runs before, vertex, next.
struct Corner {
  int next, face, before;
};

// Puts the corners of one vertex in order: each one's `before` is the following one's `next`.
void sort_around(std::vector<Corner>& corners) {
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const std::size_t wanted = (k + 1) % corners.size();
    std::size_t found = wanted;
    while (found < corners.size() && corners[found].next != corners[k].before) ++found;
    if (found == corners.size() || (wanted == 0 && found != 0))
      throw InputError("shape: an edge does not belong to exactly two faces");
    std::swap(corners[wanted], corners[found]);
  }
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
  std::vector<std::vector<Corner>> corner_at(n);
  for (int f = 0; f < faces; ++f) {
    const std::vector<int>& face = body.faces[f];
    const int m = static_cast<int>(face.size());
    if (m < 3) throw InputError("shape: a face has fewer than 3 vertices");
    for (int v : face)
      if (v < 0 || v >= n) throw InputError("shape: a face names a vertex that does not exist");
    planes.push_back(plane_of(body, face));
    for (int k = 0; k < m; ++k)
      corner_at[face[k]].push_back({face[(k + 1) % m], f, face[(k + m - 1) % m]});
  }
  for (std::vector<Corner>& corners_of : corner_at) sort_around(corners_of);

  Begin b;
  b.vertex = d_.x.size();
  b.vertices = n;
  b.padded = (n + kPad - 1) / kPad * kPad;
  b.face = d_.nx.size();
  b.faces = faces;
  b.loop_begin = d_.loop_begin.size();
  b.loop = d_.loop.size();
  b.neighbor_begin = d_.neighbor_begin.size();
  b.neighbor = d_.neighbor.size();
  b.bits = d_.vertex_faces.size();
  b.corners = d_.corners.size();
  b.words = (faces + 63) / 64;
  b.small_faces = true;
  for (const auto& face : body.faces) b.small_faces = b.small_faces && face.size() <= 8;
  d_.begin.push_back(b);

  for (int v = 0; v < b.padded; ++v) {
    const Vec3& p = body.vertices[std::min(v, n - 1)];
    d_.x.push_back(p.x());
    d_.y.push_back(p.y());
    d_.z.push_back(p.z());
  }
  d_.vertex_faces.resize(d_.vertex_faces.size() + std::size_t(n) * b.words, 0);
  std::uint64_t* bits = d_.vertex_faces.data() + b.bits;
  for (int f = 0; f < (faces + kPad - 1) / kPad * kPad; ++f) {
    const Plane& plane = planes[std::min(f, faces - 1)];
    d_.nx.push_back(plane.normal.x());
    d_.ny.push_back(plane.normal.y());
    d_.nz.push_back(plane.normal.z());
    d_.offset.push_back(plane.offset);
  }
  int loop_end = 0;
  for (int f = 0; f < faces; ++f) {
    d_.loop_begin.push_back(static_cast<std::uint16_t>(loop_end));
    for (int v : body.faces[f]) {
      d_.loop.push_back(static_cast<std::uint16_t>(v));
      bits[v * b.words + f / 64] |= std::uint64_t(1) << (f % 64);
      ++loop_end;
    }
    for (int axis = 0; axis < 3 && b.small_faces; ++axis)
      for (std::size_t k = 0; k < 8; ++k)
        d_.corners.push_back(
            body.vertices[body.faces[f][std::min(k, body.faces[f].size() - 1)]](axis));
  }
  d_.loop_begin.push_back(static_cast<std::uint16_t>(loop_end));
  int neighbor_end = 0;
  for (int v = 0; v < n; ++v) {
    d_.neighbor_begin.push_back(static_cast<std::uint16_t>(neighbor_end));
    for (const Corner& c : corner_at[v]) {
      d_.neighbor.push_back(static_cast<std::uint16_t>(c.next));
      d_.left_face.push_back(static_cast<std::uint16_t>(c.face));
      ++neighbor_end;
    }
  }
  d_.neighbor_begin.push_back(static_cast<std::uint16_t>(neighbor_end));
  d_.shapes.push_back(shape);
  renew_views();
  return size() - 1;
}

// Views of all shapes when an array has moved, else of the new one only.
void ShapeTable::renew_views() {
  const std::vector<const void*> now = {d_.x.data(),
                                        d_.y.data(),
                                        d_.z.data(),
                                        d_.nx.data(),
                                        d_.ny.data(),
                                        d_.nz.data(),
                                        d_.offset.data(),
                                        d_.corners.data(),
                                        d_.loop_begin.data(),
                                        d_.loop.data(),
                                        d_.neighbor.data(),
                                        d_.left_face.data(),
                                        d_.neighbor_begin.data(),
                                        d_.vertex_faces.data()};
  if (now != bases_) views_.clear();
  bases_ = now;
  while (views_.size() < d_.begin.size()) views_.push_back(make_view(int(views_.size())));
}

ShapeTable::ShapeTable(const ShapeTable& o) : d_(o.d_) { renew_views(); }

ShapeTable& ShapeTable::operator=(ShapeTable o) {
  d_ = std::move(o.d_);
  views_ = std::move(o.views_);
  bases_ = std::move(o.bases_);
  return *this;
}

ConvexView ShapeTable::make_view(int s) const {
  const Begin& b = d_.begin[s];
  ConvexView v;
  v.x = d_.x.data() + b.vertex;
  v.y = d_.y.data() + b.vertex;
  v.z = d_.z.data() + b.vertex;
  v.vertices = b.vertices;
  v.padded = b.padded;
  v.nx = d_.nx.data() + b.face;
  v.ny = d_.ny.data() + b.face;
  v.nz = d_.nz.data() + b.face;
  v.offset = d_.offset.data() + b.face;
  v.faces = b.faces;
  v.loop_begin = d_.loop_begin.data() + b.loop_begin;
  v.loop = d_.loop.data() + b.loop;
  v.radius = d_.shapes[s].radius;
  v.neighbor_begin = d_.neighbor_begin.data() + b.neighbor_begin;
  v.neighbor = d_.neighbor.data() + b.neighbor;
  v.left_face = d_.left_face.data() + b.neighbor;
  v.vertex_faces = d_.vertex_faces.data() + b.bits;
  v.face_words = b.words;
  v.planes_padded = true;
  v.corners = b.small_faces ? d_.corners.data() + b.corners : nullptr;
  return v;
}

}  // namespace trackbed::dem
