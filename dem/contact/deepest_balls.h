// The deepest contact of two bodies that are unions of balls: spheres and dilated polyhedra (a ball
// of radius r(x) about each point x of the core, see ConvexPart).
//
//   delta = max over x in core a, y in core b of  r_a(x) + r_b(y) - |y - x|               [m]
//
// All feature pairs of Sun, Yan, Zhao, Ji 2015 (vertex, edge, face on vertex, edge, face) are cases
// of this one problem; edge and corner regions are not left out as there, radii may differ, and the
// sign is kept when a sphere's centre enters a polyhedron. With a crown (curvature of the faces) on
// one of the two the maximum is unique, so that delta has a continuous gradient in all motions,
// also where faces or edges pass through parallel: n = (y - x)/|y - x| at x and at y. Any law with
// F = U'(delta) along n is then conservative, and the force on a face does not depend on how many
// corners it has.
//
// Method. From the nearest points a walk over features to the optimum (ball_features.h). For bodies
// without stars (shell cells), and should it not end, blocks: y <- nearest point of core b to x,
// drawn to b's centre by the crown, and the same for x; both at once within the faces or edges they
// lie on (a 2x2 problem, exact there), cut where the feature ends. Each step increases delta;
// mostly one or two rounds. Once cores themselves overlap, delta continues along the direction of
// least depth (separating_axis).
#pragma once
#include "dem/contact/closest_point.h"
#include "dem/contact/overlap.h"

namespace trackbed::dem {

/// Two balls, relative to the first body's centre, world axes.
struct DeepestBalls {
  Vec3 x, y;       ///< centres [m]
  double ra, rb;   ///< radii there [m]
  Vec3 n;          ///< unit, from x to y
  double overlap;  ///< delta [m], negative: apart by that
  /// Where x and y lie on their cores (CoreFeature::code), 0 = not known.
  int on_a = 0, on_b = 0;
};

/// A point and a polyhedron, plain or dilated. `centre` is the point, radius r; `pose` of b, its
/// place relative to a's centre. `face`: of b that the contact was on last, 1 the first, 0 = not
/// known; that it is on now.
DeepestBalls deepest_balls(const Vec3& centre, double r, const PartView& b, const Pose& pose,
                           int& face);

/// Two polyhedra, at least one of them dilated; Ra orientation of a. `start` (about a's centre,
/// world axes) is where the contact was last, `axis` a direction from a to b for cores that overlap
/// (both any length).
DeepestBalls deepest_balls(const PartView& a, const Mat3& Ra, const PartView& b, const Pose& pose,
                           const Vec3& start, Vec3& axis);

}  // namespace trackbed::dem
