#include "dem/contact/face_prism.h"

#include <algorithm>

namespace trackbed::dem {
namespace {

constexpr int kFan = FacePrism::kCorners - 2;  // triangles of a fan about the first corner

}  // namespace

void make_face_prism(const ConvexView& v, int face, int part, double height, FacePrism& out) {
  const int first = v.loop_begin[face], all = v.loop_begin[face + 1] - first;
  const int skipped = part * kFan, count = std::min(all - skipped, FacePrism::kCorners);
  const Vec3 n(v.nx[face], v.ny[face], v.nz[face]), up = height * n;
  const auto corner = [&](int k) {
    const int i = v.loop[first + (k == 0 ? 0 : skipped + k)];
    return Vec3(v.x[i], v.y[i], v.z[i]);
  };
  const int padded = (2 * count + 7) / 8 * 8;
  const auto put = [&out](int k, const Vec3& p) {
    out.x[k] = p.x(), out.y[k] = p.y(), out.z[k] = p.z();
  };
  const auto plane = [&out](int f, const Vec3& m, double offset) {
    out.nx[f] = m.x(), out.ny[f] = m.y(), out.nz[f] = m.z(), out.offset[f] = offset;
  };
  // Base 0 .. count, top count .. 2 count; faces: top, base, walls.
  for (int k = 0; k < count; ++k) put(k, corner(k)), put(count + k, corner(k) + up);
  for (int k = 2 * count; k < padded; ++k) put(k, corner(count - 1) + up);
  plane(0, n, v.offset[face] + height);
  plane(1, -n, -v.offset[face]);
  std::uint16_t* at = out.loop;
  const auto face_of = [&](int f) {
    out.loop_begin[f] = static_cast<std::uint16_t>(at - out.loop);
  };
  const auto add = [&at](int i) { *at++ = static_cast<std::uint16_t>(i); };
  face_of(0);
  for (int k = 0; k < count; ++k) add(count + k);
  face_of(1);
  for (int k = count; k-- > 0;) add(k);
  for (int k = 0; k < count; ++k) {
    const int next = (k + 1) % count;
    const Vec3 from = corner(k), out_of_face = (corner(next) - from).cross(n).normalized();
    plane(2 + k, out_of_face, out_of_face.dot(from));
    face_of(2 + k);
    add(k), add(next), add(count + next), add(count + k);
    const std::uint64_t walls = std::uint64_t(4) << k | std::uint64_t(4) << (k + count - 1) % count;
    out.vertex_faces[k] = walls | 2, out.vertex_faces[count + k] = walls | 1;
  }
  face_of(2 + count);
  ConvexView& view = out.view;
  view = ConvexView();
  view.x = out.x, view.y = out.y, view.z = out.z;
  view.vertices = 2 * count, view.padded = padded;
  view.nx = out.nx, view.ny = out.ny, view.nz = out.nz, view.offset = out.offset;
  view.faces = 2 + count;
  view.loop_begin = out.loop_begin, view.loop = out.loop;
  view.vertex_faces = out.vertex_faces, view.face_words = 1;
  view.radius = v.radius + height;
}

}  // namespace trackbed::dem
