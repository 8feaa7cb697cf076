// Grains of other shapes than one plain polyhedron, as the grain engine takes them: spheres, clumps
// of spheres, dilated polyhedra, unions of convex polyhedra. Volume and inertia are exact (a crown
// changes them by less than its height does); `body` is a convex polyhedron around the grain, for
// boxes, placement and pictures.
#pragma once
#include <vector>

#include "dem/grain/clump.h"
#include "dem/grain/dilated_shape.h"
#include "dem/grain/polyhedron.h"

namespace trackbed::dem {

/// A sphere; sieve size 2 r. Throws InputError when the radius is not positive and finite.
GrainShape sphere_shape(double radius);

/// Principal frame and sizes are the clump's.
GrainShape as_grain(const ClumpShape&);

/// A dilated polyhedron with the faces' curvature `crown_share` over the core's greatest distance
/// from the centroid (0.02: the faces of a cube rise by 0.7 % of that distance; less where the
/// radius is too small for it). Throws InputError when the radius is 0: that is a plain polyhedron.
GrainShape as_grain(const DilatedShape&, double crown_share = 0.02);

/// A body made of convex polyhedra that touch but do not overlap (dem/grain/triangle_solid.h cuts a
/// stone so). Throws InputError when there is none.
GrainShape union_shape(const std::vector<Polyhedron>& parts);

/// What pictures show: each part's surface, spheres as triangles; not one closed solid in general.
Polyhedron drawing(const GrainShape&);

/// A sphere about the origin as a polyhedron of 42 vertices around it.
Polyhedron polyhedron_around_sphere(double radius);

}  // namespace trackbed::dem
