// The two commonest contacts of polyhedra, from what they were made of in the last step, in closed
// form: no pieces, no clipping.
//
//   vertex in face: a cone from the vertex to the polygon in which its edges leave the face. With
//     base area A, depth h, J/A the base's central second moments per area [m2] and b the base's
//     centroid seen from the vertex,
//       V = A h/3,   centroid = 3/4 b,   C = V (3/5 J/A + 3/80 b b^T)
//   edge on edge: a tetrahedron between two parallel planes, corners y_i about their mean,
//       C = V/20 sum_i y_i y_i^T
//
// (C = int (x-c)(x-c)^T dV; Dirichlet's formula for polynomials over a simplex.) The frame's third
// axis is the face's normal, or normal to both edges, so that flat overlaps keep their digits.
//
// Never believed, always proved: the overlap lies within the planes named; where these enclose no
// more than the hull of the points found, and all the points lie inside all planes of both bodies,
// the two are the same.
#pragma once
#include "dem/contact/laws/pressure_law.h"
#include "dem/contact/overlap_feature.h"

namespace trackbed::dem {

struct SimpleContact {
  ContactFrame frame;  ///< third axis along the overlap's vector area, either sense
  OverlapShape shape;
  /// One body's part of the overlap's boundary, a fan of triangles around the first corner,
  /// relative to frame.origin, counter-clockwise seen from outside that body.
  Vec3 corner[8];
  int corners = 0;
  bool of_a = false;  ///< the body is a, else b
};

/// False when the overlap is of another kind now, or none, or a plane is met at a grazing angle.
bool simple_contact(const ConvexView& a, const Pose&, const ConvexView& b, const Pose&,
                    const SimpleFeature&, SimpleContact&);

/// Vertex v of one body in face `face` of another, of which the planes (padded) are all that is
/// read; `shape.area` is that of the face. `least` as for simple_contact: kLeastRise times a size.
bool vertex_in_face(const ConvexView& own, const Pose&, int v, const ConvexView& other, const Pose&,
                    int face, double least, SimpleContact&);

}  // namespace trackbed::dem
