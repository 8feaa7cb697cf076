// A dilated polyhedron in its principal frame, as GrainShape is for a plain one.
#pragma once
#include "dem/grain/dilated.h"

namespace trackbed::dem {

/// Moved so that its centroid is the origin and its principal axes the coordinate axes.
struct DilatedShape {
  DilatedPolyhedron body;
  double volume = 0;            ///< [m3]
  Vec3 inertia = Vec3::Zero();  ///< principal moments at density 1 [m5], ascending
  double radius = 0;            ///< of the bounding sphere about the centroid [m]
  double sieve_size = 0;        ///< 0: not sized
  Vec3 origin = Vec3::Zero();   ///< pose of this frame in the frame it was made from
  Quat turn = Quat::Identity();
};
/// Throws as mass_properties.
DilatedShape make_dilated_shape(const DilatedPolyhedron&);

/// As of a GrainShape. Throws InputError when the factor is not positive and finite.
DilatedShape scaled(const DilatedShape&, double factor);

/// The dilated polyhedron of the same sieve size as the plain one: the core is scaled so that its
/// exact size plus 2 r is the size that was, r given as a share of that size. Throws InputError
/// unless 0 <= share < 0.5 or when the shape is not sized.
DilatedShape dilate_within(const GrainShape& sized, double share);

}  // namespace trackbed::dem
