// The common part of a polygon and a disc: closed forms.
#pragma once
#include <vector>

#include "dem/types.h"

namespace trackbed::dem {

/// Integrals over a plane region bounded by lines and arcs, coordinates from the disc's centre.
struct DiscRegion {
  double area = 0;                                   ///< of 1 [m2]
  Vec2 first = Vec2::Zero();                         ///< of x [m3]
  Eigen::Matrix2d second = Eigen::Matrix2d::Zero();  ///< of x x' [m4]
  double angle = 0;  ///< solid angle seen from the sphere's centre, signed as h
};

/// The polygon's part within the disc of radius `rho` about the origin; negative where the polygon
/// runs clockwise. The disc is cut from the sphere of `radius` by a plane at the distance h (only
/// the solid angle needs them).
DiscRegion disc_within(const std::vector<Vec2>& polygon, double rho, double h, double radius);

}  // namespace trackbed::dem
