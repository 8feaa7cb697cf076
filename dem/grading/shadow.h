// The shadow of a convex polyhedron along a direction, and rectangles around it.
#pragma once
#include <vector>

#include "dem/grain/polyhedron.h"

namespace trackbed::dem {

/// Area vectors of the faces [m2], outward.
std::vector<Vec3> face_areas(const Polyhedron&);

/// Shadow area along the unit direction u, half the sum of |A_f . u| [m2].
double shadow_area(const std::vector<Vec3>& face_areas, const Vec3& u);

/// The shadow's corners, counter-clockwise, without collinear ones.
std::vector<Vec2> shadow(const Polyhedron&, const Vec3& u);

/// The rectangle of least area around a convex polygon; one side lies on a side of the polygon.
struct Rectangle {
  double p = 0, q = 0;  ///< p >= q [m]
};
Rectangle least_rectangle(const std::vector<Vec2>& polygon);

/// Edge of the least square around a convex polygon with one side on a side of the polygon [m].
double least_flush_square(const std::vector<Vec2>& polygon);

/// Edge of the least square around a convex polygon [m], turned as it fits best; exact. Between two
/// angles at which a side of the polygon touches the square, both widths are concave in the angle,
/// so the larger is least at such an angle or where both are equal.
double least_square(const std::vector<Vec2>& polygon);

}  // namespace trackbed::dem
