// A dilated polyhedron: the Minkowski sum of a convex polyhedron (the core) and a ball of radius r,
// as Sun, Yan, Zhao, Ji 2015 (1). They integrate volume and inertia over small cells; here both are
// exact. The body is the core, a prism of height r on every face, a sector of a cylinder along
// every edge and a spherical sector at every vertex (the cone of the outward normals of its faces).
#pragma once
#include "dem/grain/polyhedron.h"

namespace trackbed::dem {

struct DilatedPolyhedron {
  Polyhedron core;    ///< convex
  double radius = 0;  ///< r [m], >= 0; 0: the core itself
};

/// M = sum over edges of L (pi - dihedral angle) / 2 [m], the integral of mean curvature. Cube of
/// edge 1: 3 pi; box: pi (a + b + c).
double mean_curvature(const Polyhedron&);

/// Steiner: V(r) = V + S r + M r^2 + 4/3 pi r^3 [m3].
double dilated_volume(const DilatedPolyhedron&);

/// Volume, centroid and inertia of a body of density 1, exact. Second moments of the pieces: of a
/// face (area A, first moment a, second B, normal n)   r B + r^2/2 (a n' + n a') + r^3/3 A n n';
/// of an edge (length L, first moment a, second B, exterior angle t, m the unit vectors between the
/// two normals)   r^2/2 t B + r^3/3 (a <m>' + <m> a') + r^4/4 L <m m'>;   of a vertex p (solid
/// angle w of its normal cone)   r^3/3 w p p' + r^4/4 (p <m>' + <m> p');   of all vertices together
/// 4/15 pi r^5 1. <.> are integrals over angle or solid angle. Throws InputError: radius negative
/// or not finite, no solid.
MassProperties mass_properties(const DilatedPolyhedron&);

}  // namespace trackbed::dem
