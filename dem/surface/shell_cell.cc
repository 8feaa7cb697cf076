#include "dem/surface/shell_cell.h"

#include <algorithm>
#include <cmath>

namespace trackbed::dem {
namespace {

// Faces of a tetrahedron with (v1-v0) x (v2-v0) . (v3-v0) > 0, counter-clockwise from outside.
constexpr std::uint16_t kLoop[12] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
constexpr std::uint16_t kLoopBegin[5] = {0, 3, 6, 9, 12};

std::array<int, 3> sorted(std::array<int, 3> t) {
  std::sort(t.begin(), t.end());
  return t;
}

}  // namespace

std::array<Vec3, 4> cell_corners(const SurfacePatch& patch, int cell) {
  const std::array<int, 3> t = sorted(patch.triangle[cell / 3]);
  const auto outer = [&](int k) { return patch.node[t[k]]; };
  const auto inner = [&](int k) -> Vec3 { return patch.node[t[k]] + patch.inset[t[k]]; };
  switch (cell % 3) {
    case 0:
      return {outer(0), outer(1), outer(2), inner(2)};
    case 1:
      return {outer(0), outer(1), inner(1), inner(2)};
    default:
      return {outer(0), inner(0), inner(1), inner(2)};
  }
}

void make_shell_cell(const SurfacePatch& patch, int cell, const Vec3& shift, ShellCell& out) {
  std::array<Vec3, 4> v = cell_corners(patch, cell);
  const Vec3 base = v[0];
  for (Vec3& p : v) p -= base;
  const bool mirrored = v[1].cross(v[2]).dot(v[3]) < 0;
  if (mirrored) std::swap(v[0], v[1]);
  out.origin = base + shift;
  double radius2 = 0;
  for (int i = 0; i < 8; ++i) {
    const Vec3& p = v[std::min(i, 3)];
    out.x[i] = p.x(), out.y[i] = p.y(), out.z[i] = p.z();
    radius2 = std::max(radius2, p.squaredNorm());
  }
  for (int f = 0; f < 4; ++f) {
    const Vec3 &p = v[kLoop[3 * f]], &q = v[kLoop[3 * f + 1]], &r = v[kLoop[3 * f + 2]];
    const Vec3 n = (q - p).cross(r - p).normalized();
    out.nx[f] = n.x(), out.ny[f] = n.y(), out.nz[f] = n.z();
    out.offset[f] = n.dot(p);
  }
  // Corner 3 of the first cell is the only inner one, so its opposite face is the surface; corner 0
  // (1 if swapped) of the last cell the only outer one.
  out.outer_face = cell % 3 == 0 ? 0 : -1;
  out.inner_face = cell % 3 == 2 ? (mirrored ? 2 : 3) : -1;
  ConvexView& view = out.view;
  view.x = out.x, view.y = out.y, view.z = out.z;
  view.vertices = 4, view.padded = 8;
  view.nx = out.nx, view.ny = out.ny, view.nz = out.nz, view.offset = out.offset;
  view.faces = 4;
  view.loop_begin = kLoopBegin, view.loop = kLoop;
  view.radius = std::sqrt(radius2);
}

Vec3 triangle_normal(const SurfacePatch& patch, int triangle) {
  const auto& t = patch.triangle[triangle];
  return (patch.node[t[1]] - patch.node[t[0]])
      .cross(patch.node[t[2]] - patch.node[t[0]])
      .normalized();
}

}  // namespace trackbed::dem
