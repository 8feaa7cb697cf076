// A clump's body: the union of spheres, its exact mass properties, and the virtual slices of Jin,
// Zeng, Ye, Li 2017 (section 3).
#pragma once
#include <vector>

#include "dem/grain/polyhedron.h"

namespace trackbed::dem {

struct Sphere {
  Vec3 centre = Vec3::Zero();  ///< [m]
  double radius = 0;           ///< [m]
};

/// Of the union, overlaps counted once; closed form. Each sphere keeps its part of the power
/// diagram, {x : |x-c_i|^2 - R_i^2 <= |x-c_j|^2 - R_j^2}: a ball cut by planes. With G the disc of
/// a cut that remains (at distance h, normal n) and E the part of the sphere,
///   volume  V = sum h |G| / 3 + R^3 <1>_E / 3,   <1>_E = 4 pi - solid angles of the G,
///   first   sum h/4 <x>_G + R^4/4 <m>_E,         R^2 <m>_E = -sum n |G|,
///   second  sum h/5 <x x'>_G + R^5/5 <m m'>_E,   R^3 <m m'>_E = V 1 - sum n <x>_G',
/// the right sides by the divergence theorem. Throws InputError: no sphere, a radius that is not
/// positive, a coordinate that is not finite.
MassProperties mass_properties(const std::vector<Sphere>&);

struct Disc {
  double x = 0, y = 0, radius = 0;  ///< [m]
};

/// The discs in which the plane z = `z` cuts the spheres, radius sqrt(R^2 - (z - z0)^2): (2).
std::vector<Disc> slice(const std::vector<Sphere>&, double z);

/// Area of the union of discs [m2], exact, from the arcs of its outline.
double union_area(const std::vector<Disc>&);
/// Of its part within a disc or a rectangle.
double union_area_in_disc(std::vector<Disc>, const Vec2& centre, double radius);
double union_area_in_rectangle(const std::vector<Disc>&, const Vec2& low, const Vec2& high);

/// Volume by horizontal slices, so many across the least sphere as the paper takes (100), each
/// slice's area at its middle times its thickness. The paper's pixels (2.7 % too much for one
/// sphere) are replaced by exact areas. Throws as mass_properties; slices < 1.
double sliced_volume(const std::vector<Sphere>&, int slices_per_least_sphere = 100);

}  // namespace trackbed::dem
