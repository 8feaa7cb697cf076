// The point of a convex polyhedron, or of a triangle, that is nearest to a given one.
#pragma once
#include "dem/contact/shape_table.h"

namespace trackbed::dem {

/// Where a point projects to. `dimension`: 0 a vertex, 1 an edge, 2 a face, 3 the point is inside
/// (then `point` is the nearest one of the face of least depth, by planes).
struct ClosestPoint {
  Vec3 point;
  int dimension = 2;
  int face = -1;  ///< one that holds the point
  int edge = -1;  ///< which edge of that face's loop, for dimension 1
  Vec3 along;     ///< unit normal of the face (2, 3), unit direction of the edge (1)
};

/// In the polyhedron's own frame [m]. `likely`: a face to try first, -1 = none; with it as without.
ClosestPoint closest_point(const ConvexView&, const Vec3& p, int likely = -1);

/// Of a triangle, with the weights of its corners.
Vec3 closest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c,
                         double weight[3]);

}  // namespace trackbed::dem
