// A closed convex polyhedron and its exact mass properties.
#pragma once
#include <vector>

#include "dem/types.h"

namespace trackbed::dem {

/// Vertices [m] and faces; each face lists its vertices counter-clockwise seen from outside.
/// Coplanar facets are one face.
struct Polyhedron {
  std::vector<Vec3> vertices;
  std::vector<std::vector<int>> faces;
};

/// Of a body of density 1: volume [m3], centroid [m], inertia tensor about the centroid [m5].
struct MassProperties {
  double volume = 0;
  Vec3 centroid = Vec3::Zero();
  Mat3 inertia = Mat3::Zero();
};

/// Exact, by the divergence theorem over the faces (signed tetrahedra from an inner point).
/// Throws InputError when the volume is not positive (open, inverted or flat solid, NaN).
MassProperties mass_properties(const Polyhedron&);

/// Box with the given full edge lengths [m], centred at the origin.
Polyhedron make_box(const Vec3& edges);

/// Convex hull of points [m] (CGAL). `tolerance` is a share of the points' extent: points nearer to
/// each other than that are one, facets coplanar within it become one face, and vertices inside a
/// face or an edge are dropped. Throws InputError when the points are coplanar or not finite.
Polyhedron convex_hull(const std::vector<Vec3>& points, double tolerance = 1e-9);

/// A convex part of a grain: all points within r(x) of a point x of its core. A sphere has a point
/// as core (one vertex, no face), a plain polyhedron radius 0, a dilated polyhedron both.
///   r(x) = radius + crown/2 (mean_square - |x|^2)                                        [m]
/// `crown` > 0 lets r grow a little towards the middle of faces, as rollers are crowned: the
/// deepest point of a contact is then unique and moves smoothly when faces tilt through parallel.
struct ConvexPart {
  Polyhedron core;         ///< body frame [m]
  double radius = 0;       ///< [m]
  double crown = 0;        ///< curvature of a face [1/m]
  double mean_square = 0;  ///< of |x| over the core's surface [m2]; crown keeps the mean radius
};

/// The shape moved so that its centroid is the origin and its principal axes of inertia are the
/// coordinate axes (right-handed, moments ascending); `inertia` holds the principal moments at
/// density 1 [m5]. What every grain and rigid body is stored as (spheres, clumps, dilated and
/// non-convex grains: grain/parts.h).
struct GrainShape {
  Polyhedron body;                ///< convex; the grain itself, or what encloses its parts
  std::vector<ConvexPart> parts;  ///< what touches; empty: `body` does
  double volume = 0;              ///< [m3]
  Vec3 inertia = Vec3::Zero();    ///< principal moments at density 1 [m5]
  double radius = 0;              ///< of the bounding sphere about the centroid [m]
  double sieve_size = 0;          ///< least square hole it passes [m]; 0 = not sized
  // Pose of this principal frame in the frame of the polyhedron it was made from.
  Vec3 origin = Vec3::Zero();
  Quat turn = Quat::Identity();
};
GrainShape make_grain_shape(const Polyhedron&);

/// The shape times `factor` > 0: lengths, sieve size, origin, parts; volume factor^3, inertia
/// factor^5.
/// Throws InputError when the factor is not positive and finite.
GrainShape scaled(const GrainShape&, double factor);

}  // namespace trackbed::dem
