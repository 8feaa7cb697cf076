// Virtual slices through a packing: what a saw cut would show (Jin, Zeng, Ye, Li 2017, Fig. 10).
#pragma once
#include <string>
#include <vector>

#include "dem/packing/measure.h"

namespace trackbed::dem {

/// The plane x[axis] = position; its picture has the other two axes in the order x, y, z.
struct CuttingPlane {
  int axis = 2;         ///< 2: a horizontal cut
  double position = 0;  ///< [m]
};

/// Of one grain (or an image of it): a closed outline [m]; a clump has one per sphere, overlapping,
/// a grain of several polyhedra one of each.
struct SectionPiece {
  int grain = 0;
  std::vector<Vec2> outline;
};

/// Outlines of all grains in the plane; discs as polygons of 48 corners.
std::vector<SectionPiece> section(const std::vector<PlacedGrain>&, const Vec3& period,
                                  const CuttingPlane&);

/// CSV "axis,position_m,piece,grain,a_m,b_m", a line a corner; a, b along the picture's axes.
std::string to_csv(const std::vector<CuttingPlane>&, const std::vector<std::vector<SectionPiece>>&);

/// So many planes across an axis of the region, evenly spaced, none on its border.
std::vector<CuttingPlane> evenly_spaced(const MeasuredRegion&, int axis, int count);

}  // namespace trackbed::dem
