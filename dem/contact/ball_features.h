// The deepest balls again from the features they lay on in the last step: a vertex, an edge or a
// face of each core, proved.
//
// The problem of deepest_balls.h is convex, so that a point which is best among its neighbours is
// the best of all. With the features known x and y follow from one equation for the distance d:
//
//   vertex x on a face or edge   d^2 = h^2 + w^2 q^2,  w = e/(1+e),  e = crown d
//     (h to the plane or line, q from the foot to that of the centre: the crown draws y there)
//   two edges; a face on an edge or a face      a linear problem of one or two unknowns for given d
//
// solved by iteration, which gains five digits a round. The proof: from a vertex no edge leads
// downhill, from an edge neither of its faces does, and a point of a face lies within it.
#pragma once
#include "dem/contact/deepest_balls.h"

namespace trackbed::dem {

/// A vertex; one of its edges (ConvexView::neighbor); or a face of a polyhedron.
struct CoreFeature {
  int dimension = -1;  ///< 0, 1, 2; -1 = not known
  int index = 0;       ///< of the vertex, of the face
  int edge = 0;        ///< which of the vertex's
  /// In one int, 0 = not known, for a pair to keep.
  int code() const { return dimension + 1 + (index << 2) + (edge << 18); }
  static CoreFeature of(int code) { return {(code & 3) - 1, code >> 2 & 65535, code >> 18}; }
};

/// Cores nearer than this touch each other [m]: the direction from one to the other is lost.
inline double least_distance(const PartView& a, const PartView& b) {
  return 1e-6 * (a.radius + b.radius);
}

/// The one that the point of a search lies on.
CoreFeature feature_of(const ConvexView&, const ClosestPoint&, const Vec3& point);

/// The search from any two features and points of them (own frames), which are near the deepest
/// balls: to the best point of the features, or as far as they reach and on to what bounds them, or
/// from there to a larger feature that goes downhill; each step is one. False when it has not come
/// to an end after many, when cores touch, and for views without stars.
bool walk_to_deepest_balls(const PartView& a, const Mat3& Ra, const PartView& b, const Pose&,
                           CoreFeature on_a, const Vec3& x, CoreFeature on_b, const Vec3& y,
                           DeepestBalls&);

/// As deepest_balls() of two polyhedra. False when the balls lie on other features now, when the
/// cores touch each other, where parallel ones without a crown leave the place
/// open, and for views without stars.
bool deepest_balls_again(const PartView& a, const Mat3& Ra, const PartView& b, const Pose&,
                         const CoreFeature& on_a, const CoreFeature& on_b, DeepestBalls&);

}  // namespace trackbed::dem
