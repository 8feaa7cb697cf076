// Shape indices of convex grains.
#pragma once
#include <vector>

#include "dem/grain/polyhedron.h"

namespace trackbed::dem {

struct ShapeIndices {
  /// Edges L >= I >= S [m] of the least-volume box with one side on a face of the grain.
  double length = 0, intermediate = 0, shortest = 0;
  double elongation = 0;  ///< I/L [-]
  double flatness = 0;    ///< S/I [-]
  double width = 0;       ///< least distance of two parallel planes that hold the grain [m], exact
  double diameter = 0;    ///< largest distance of two points [m]
  double surface = 0;     ///< [m2]
  /// Wadell: surface of the sphere of equal volume over the grain's surface [-]; cube (pi/6)^(1/3).
  double sphericity = 0;
  /// Mean angle between the normals of neighbouring faces, weighted by edge length, over pi/2 [-]:
  /// cube 1, ball 0, regular tetrahedron 1.2163.
  double angularity = 0;
};

/// Throws InputError when the grain has no volume.
ShapeIndices shape_indices(const Polyhedron&);

/// ShapeIndices::angularity alone.
double angularity(const Polyhedron&);

/// Shares of a library's volume [%].
struct LibraryIndices {
  double flaky = 0;      ///< thickness (least width) < 0.6 of the sieve size (BS 812, TB/T 2140)
  double elongated = 0;  ///< length (diameter) > 1.8 of the sieve size (BS 812, TB/T 2140)
  double slender = 0;    ///< length over thickness > 3 (shape index, EN 933-4)
};

/// The standards compare with the mean size of the grain's sieve class; here it is the grain's own
/// sieve size, which a normalised library knows. Of the shapes and the indices of each. Throws
/// InputError: empty, or a shape is not sized.
LibraryIndices library_indices(const std::vector<GrainShape>&, const std::vector<ShapeIndices>&);

}  // namespace trackbed::dem
