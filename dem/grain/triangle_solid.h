// A solid bounded by triangles, not convex in general: Jin's stones, scanned stones.
#pragma once
#include <array>
#include <vector>

#include "dem/grain/polyhedron.h"

namespace trackbed::dem {

/// Closed surface; triangles anticlockwise seen from outside.
struct TriangleSolid {
  std::vector<Vec3> vertices;  ///< [m]
  std::vector<std::array<int, 3>> triangles;
};

/// Exact, as of a polyhedron. Throws InputError when the surface is open, inside-out or flat.
MassProperties mass_properties(const TriangleSolid&);

/// Distance of a point to the surface [m], positive inside, negative outside. Inside is where the
/// solid angle of the surface seen from the point is above 2 pi.
double depth(const TriangleSolid&, const Vec3& point);

/// The tetrahedra of `centre` and each triangle: convex parts that fill the solid when all of its
/// surface is seen from the centre (Jin's stones: from the origin). Throws InputError when it is
/// not.
std::vector<Polyhedron> star_parts(const TriangleSolid&, const Vec3& centre = Vec3::Zero());

}  // namespace trackbed::dem
