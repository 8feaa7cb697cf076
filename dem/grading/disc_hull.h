// The convex hull of discs in the plane.
#pragma once
#include <vector>

#include "dem/grain/sphere_union.h"

namespace trackbed::dem {

/// An arc of the hull: `disc` reaches farthest in the directions from `angle` to the next arc's.
struct HullArc {
  double angle = 0;  ///< [rad]
  int disc = 0;
};

/// Arcs by ascending angle in [0, 2 pi), the first at 0. By wrapping: from arc to arc along common
/// tangents. Requires at least one disc.
std::vector<HullArc> disc_hull(const std::vector<Disc>&);

}  // namespace trackbed::dem
