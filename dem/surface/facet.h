// What lies behind one triangle of a surface, down to the shell's depth: a prism whose sides run
// along the insets of its corners.
#pragma once
#include "dem/contact/shape_table.h"
#include "dem/surface/patch.h"

namespace trackbed::dem {

/// World axes, relative to `origin`.
struct Facet {
  Vec3 origin, normal;  ///< first corner; unit, towards the grains
  double depth = 0;     ///< nothing of the shell's bottom is less deep below the surface [m]
  /// Outward planes of the sides, n.p <= offset inside: side k stands on the edge from corner k to
  /// k+1. Where the insets of its ends differ it is two triangles (patch_forces.h) with a plane
  /// each, else the planes are the same.
  struct Side {
    Vec3 normal[2];
    double offset[2];
    bool plane = false;
  } side[3];
  double x[8], y[8], z[8];                ///< the six corners, padded
  double nx[8], ny[8], nz[8], offset[8];  ///< the surface, the sides, two each, the bottom

  /// Views that point into this: the corners' hull, for separating_axis alone, and eight planes
  /// that enclose nothing but shell, the surface first.
  ConvexView hull() const;
  ConvexView planes() const;
};

/// Fills all of it for a triangle moved by `shift`.
void make_facet(const SurfacePatch&, int triangle, const Vec3& shift, Facet&);

}  // namespace trackbed::dem
