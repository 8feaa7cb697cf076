#include "dem/surface/facet.h"

#include <algorithm>
#include <cmath>

namespace trackbed::dem {
namespace {

void set_plane(Facet::Side& side, int which, const Vec3& normal, const Vec3& through) {
  side.normal[which] = normal.normalized();
  side.offset[which] = side.normal[which].dot(through);
}

}  // namespace

void make_facet(const SurfacePatch& patch, int triangle, const Vec3& shift, Facet& f) {
  const std::array<int, 3>& t = patch.triangle[triangle];
  Vec3 p[3];
  for (int k = 0; k < 3; ++k) p[k] = patch.node[t[k]] - patch.node[t[0]];
  f.origin = patch.node[t[0]] + shift;
  f.normal = p[1].cross(p[2]).normalized();
  f.depth = patch.shell_depth;
  for (int k = 0; k < 3; ++k) f.depth = std::min(f.depth, -f.normal.dot(patch.inset[t[k]]));
  for (int k = 0; k < 3; ++k) {
    const int next = k == 2 ? 0 : k + 1;
    const Vec3 edge = p[next] - p[k];
    const Vec3 &in = patch.inset[t[k]], &next_in = patch.inset[t[next]];
    Facet::Side& side = f.side[k];
    set_plane(side, 0, in.cross(edge), p[k]);
    side.plane = (in - next_in).cwiseAbs().maxCoeff() < 1e-12 * patch.shell_depth;
    if (side.plane) {
      side.normal[1] = side.normal[0], side.offset[1] = side.offset[0];
    } else if (t[k] < t[next]) {  // the diagonal runs from the lower outer to the higher inner node
      set_plane(side, 0, next_in.cross(edge), p[k]);
      set_plane(side, 1, in.cross(edge + next_in), p[k]);
    } else {
      set_plane(side, 1, next_in.cross(edge - in), p[next]);
    }
  }
  const auto plane = [&](int i, const Vec3& n, double offset) {
    f.nx[i] = n.x(), f.ny[i] = n.y(), f.nz[i] = n.z(), f.offset[i] = offset;
  };
  plane(0, f.normal, 0);
  for (int k = 0; k < 6; ++k)
    plane(1 + k, f.side[k / 2].normal[k % 2], f.side[k / 2].offset[k % 2]);
  plane(7, -f.normal, f.depth);
  for (int i = 0; i < 8; ++i) {
    const int k = std::min(i, 5);
    const Vec3 q = k < 3 ? p[k] : Vec3(p[k - 3] + patch.inset[t[k - 3]]);
    f.x[i] = q.x(), f.y[i] = q.y(), f.z[i] = q.z();
  }
}

ConvexView Facet::hull() const {
  ConvexView view;
  view.x = x, view.y = y, view.z = z;
  view.vertices = 6, view.padded = 8;
  double radius2 = 0;
  for (int i = 0; i < 6; ++i) radius2 = std::max(radius2, x[i] * x[i] + y[i] * y[i] + z[i] * z[i]);
  view.radius = std::sqrt(radius2);
  return view;
}

ConvexView Facet::planes() const {
  ConvexView view;
  view.nx = nx, view.ny = ny, view.nz = nz, view.offset = offset;
  view.faces = 8, view.planes_padded = true;
  return view;
}

}  // namespace trackbed::dem
