// Where a sphere or a dilated polyhedron is deepest in a deforming surface: the deepest balls
// (contact/deepest_balls.h) over all triangles near it.
#pragma once
#include <vector>

#include "dem/contact/shape_table.h"
#include "dem/surface/patch.h"

namespace trackbed::dem {

/// A triangle near a grain, its periodic image, and by how much the grain's deepest balls overlap
/// it at most (negative: apart) [m]; `exact` where they were looked for.
struct NearTriangle {
  int triangle = -1;
  Vec3 shift = Vec3::Zero();
  double overlap = HUGE_VAL;
  bool exact = false;
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

/// No point of a part with these deepest balls is deeper behind the surface [m]: as in
/// flat_contact().
double thickness(const PartView&, const SurfaceBalls&);

/// Of a dilated polyhedron at x, orientation R; `start` is where the contact was last, from x.
/// Only triangles are looked at whose bound lets them hold the deepest balls; with `aside` > 0 also
/// those that the part overlaps or misses by less than aside times its thickness. Sets their
/// overlaps.
SurfaceBalls core_on_surface(const PartView&, const Vec3& x, const Mat3& R, const Vec3& start,
                             const SurfacePatch&, double aside, std::vector<NearTriangle>&);

}  // namespace trackbed::dem
