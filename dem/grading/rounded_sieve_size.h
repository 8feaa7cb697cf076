// Sieve sizes of rounded grains by their true outline: dilated polyhedra and sphere clumps.
#pragma once
#include <vector>

#include "dem/grading/sieve_size.h"
#include "dem/grain/dilated.h"
#include "dem/grain/sphere_union.h"

namespace trackbed::dem {

/// The dilated grain is wider than its core by 2 r in every direction, so its exact size is the
/// core's plus 2 r. Methods: exact; elias2014 (projection along the axis of least inertia of the
/// dilated body); equal_cube and equal_sphere of its own volume. Throws InputError: the other
/// methods (their rules name directions of a polyhedron), no solid.
double sieve_size(const DilatedPolyhedron&, SieveMethod = SieveMethod::exact);

/// Of a clump, methods as for dilated grains.
double sieve_size(const std::vector<Sphere>&, SieveMethod = SieveMethod::exact);

/// As of a polyhedron, with w(u) = max (c_i.u + R_i) - min (c_j.u - R_j): the largest of d.u + rho
/// over pairs of spheres, d = c_i - c_j, rho = R_i + R_j.
ExactSieveSize exact_sieve_size(const std::vector<Sphere>&, double tolerance = 1e-6);

}  // namespace trackbed::dem
