// Where a sphere or a dilated polyhedron is deepest in a deforming surface: the deepest balls
// (contact/deepest_balls.h) over all triangles near it.
#pragma once
#include <vector>

#include "dem/contact/shape_table.h"
#include "dem/surface/patch.h"

namespace trackbed::dem {

/// A triangle near a grain, its periodic image, and by how much the grain's deepest balls overlap
/// it (negative: apart) [m].
struct NearTriangle {
  int triangle = -1;
  Vec3 shift = Vec3::Zero();
  double overlap = 0;
};

struct SurfaceBalls {
  double overlap = -HUGE_VAL;  ///< [m]
  double reach = 0;            ///< r at the deepest point [m]
  Vec3 n, y;                   ///< into the surface; on the surface, relative to the grain's centre
  NearTriangle on;             ///< the triangle of y; none: nothing is near
  double weight[3];            ///< of its corners at y
};

/// Of a sphere about `centre`, seen from the grain's centre x. A centre may lie below the surface,
/// as deep as the patch's shell.
SurfaceBalls sphere_on_surface(const Vec3& x, const Vec3& centre, double r, const SurfacePatch&,
                               const std::vector<NearTriangle>&);

/// Of a dilated polyhedron at x, orientation R; `start` is where the contact was last, from x. Sets
/// the triangles' overlaps.
SurfaceBalls core_on_surface(const PartView&, const Vec3& x, const Mat3& R, const Vec3& start,
                             const SurfacePatch&, std::vector<NearTriangle>&);

}  // namespace trackbed::dem
