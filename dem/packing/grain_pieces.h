// What a packed grain is made of, for files.
#pragma once
#include <vector>

#include "dem/grain/sphere_union.h"

namespace trackbed::dem {

/// polyhedron: the grain's body itself; spheres: one or a clump; dilated: one core and a radius;
/// pieces: a union of convex solids.
enum class GrainKind { polyhedron, spheres, dilated, pieces };
GrainKind kind_of(const GrainShape&);
const char* name_of(GrainKind);

/// The spheres of a grain that is made of spheres, in its principal frame.
std::vector<Sphere> spheres_of(const GrainShape&);

/// The grain's outline in its principal frame as closed convex solids: its body, or one of each
/// part. A sphere is a polyhedron of 42 vertices and the sphere's volume, a dilated polyhedron the
/// outline that it is measured by (rounded_outline). Pieces may overlap, as a clump's spheres do.
std::vector<Polyhedron> outline_pieces(const GrainShape&);

}  // namespace trackbed::dem
