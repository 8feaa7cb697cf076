#include "dem/contact/shape_table.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>
#include <utility>

#include "base/error.h"

namespace trackbed::dem {
namespace {

constexpr double kFlatCrown = 1e-3;

int padded_to_eight(int n) { return (n + 7) / 8 * 8; }

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
  views_.push_back(add_view(shape.body, shape.radius, shape.parts.empty()));
  if (shape.parts.empty()) {
    parts_.emplace_back();
    parts_.back().core = views_.back();
  }
  for (const ConvexPart& given : shape.parts) {
    PartView part;
    part.radius = given.radius, part.crown = given.crown, part.mean_square = given.mean_square;
    if (given.core.faces.empty()) {
      if (given.core.vertices.size() != 1 || !(given.radius > 0))
        throw InputError("shape: a part without faces is one point with a radius");
      part.kind = Core::point;
      part.centre = given.core.vertices[0];
      part.centred = part.centre == Vec3::Zero();
    } else {
      double most = 0;
      for (const Vec3& v : given.core.vertices) most = std::max(most, v.norm());
      part.kind = given.radius > 0 ? Core::dilated : Core::plain;
      part.core = add_view(given.core, most, true);
    }
    parts_.push_back(part);
  }
  for (std::size_t k = flat_parts_.size(); k < parts_.size(); ++k) {
    PartView part = parts_[k];
    balls_.push_back({part.centre, part.radius});
    const double most = part.core.radius;
    if (part.kind == Core::dilated) part.crown = kFlatCrown / most, part.mean_square = most * most;
    flat_parts_.push_back(part);
  }
  part_first_.push_back(static_cast<int>(parts_.size()));
  shapes_.push_back(shape);
  return size() - 1;
}

ConvexView ShapeTable::add_view(const Polyhedron& body, double radius, bool touches) {
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

  const int padded = padded_to_eight(n), padded_faces = padded_to_eight(faces);
  const int words = (faces + 63) / 64;
  bool small_faces = touches;
  for (const auto& face : body.faces) small_faces = small_faces && face.size() <= 8;

  int star = 8;
  for (const auto& c : corner_at)
    if (c.size() <= 7) star = std::max(star, padded_to_eight(4 + 3 * static_cast<int>(c.size())));

  auto arrays = std::make_shared<Arrays>();
  const std::size_t reals = 3 * padded + 4 * padded_faces + (small_faces ? 24 * faces : 0),
                    star_reals = touches ? n * star + 8 : 0;
  double* real = reals_.take(reals + star_reals);
  ConvexView view;
  const auto take = [&real](std::size_t count) { return std::exchange(real, real + count); };
  double *nx = take(padded_faces), *ny = take(padded_faces), *nz = take(padded_faces),
         *offset = take(padded_faces);
  for (int f = 0; f < padded_faces; ++f) {
    const Plane& plane = planes[std::min(f, faces - 1)];
    nx[f] = plane.normal.x(), ny[f] = plane.normal.y(), nz[f] = plane.normal.z();
    offset[f] = plane.offset;
  }
  double* at_vertex = take(star_reals);
  if (touches) view.stars = at_vertex, view.star_size = star;
  for (int v = 0; touches && v < n; ++v, at_vertex += star) {
    const Vec3& p = body.vertices[v];
    double* at = std::copy(p.data(), p.data() + 3, at_vertex) + 1;
    if (corner_at[v].size() > 7 || faces > 64) continue;
    unsigned char counts[8] = {static_cast<unsigned char>(corner_at[v].size())};
    for (std::size_t k = 0; k < corner_at[v].size(); ++k)
      counts[1 + k] = static_cast<unsigned char>(corner_at[v][k].face);
    std::memcpy(at_vertex + 3, counts, 8);
    for (int axis = 0; axis < 3; ++axis)
      for (const Corner& c : corner_at[v]) *at++ = body.vertices[c.next][axis] - p[axis];
  }
  double *x = take(padded), *y = take(padded), *z = take(padded);
  for (int v = 0; v < padded; ++v) {
    const Vec3& p = body.vertices[std::min(v, n - 1)];
    x[v] = p.x(), y[v] = p.y(), z[v] = p.z();
  }
  if (small_faces) {
    view.corners = real;
    for (const std::vector<int>& face : body.faces)
      for (int axis = 0; axis < 3; ++axis)
        for (std::size_t k = 0; k < 8; ++k)
          *real++ = body.vertices[face[std::min(k, face.size() - 1)]](axis);
  }

  arrays->bits.resize(std::size_t(n) * words);
  for (int f = 0; f < faces; ++f)
    for (int v : body.faces[f]) arrays->bits[v * words + f / 64] |= std::uint64_t(1) << (f % 64);

  std::vector<std::uint16_t>& index = arrays->indices;
  const auto put = [&index](std::size_t i) { index.push_back(static_cast<std::uint16_t>(i)); };
  std::size_t end = 0;
  for (const auto& c : corner_at) put(end), end += c.size();
  put(end);
  for (const auto& at : corner_at)
    for (const Corner& c : at) put(c.next);
  for (const auto& at : corner_at)
    for (const Corner& c : at) put(c.face);
  end = 0;
  for (const auto& face : body.faces) put(end), end += face.size();
  put(end);
  for (const auto& face : body.faces)
    for (int v : face) put(v);

  view.x = x, view.y = y, view.z = z;
  view.vertices = n, view.padded = padded;
  view.nx = nx, view.ny = ny, view.nz = nz, view.offset = offset;
  view.faces = faces;
  view.radius = radius;
  view.neighbor_begin = index.data();
  view.neighbor = view.neighbor_begin + n + 1;
  view.left_face = view.neighbor + corners;
  view.loop_begin = view.left_face + corners;
  view.loop = view.loop_begin + faces + 1;
  view.vertex_faces = arrays->bits.data();
  view.face_words = words;
  view.planes_padded = true;
  arrays_.push_back(std::move(arrays));
  return view;
}

}  // namespace trackbed::dem
