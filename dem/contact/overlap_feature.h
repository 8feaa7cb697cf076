// An overlap found from what it was made of in the last step: a vertex and a face, two edges (the
// two commonest, in closed form: simple_contact.h), or else the faces that bounded it. While these
// still are what meets, no other part of the bodies need be looked at, except to prove it:
//
//   faces: a face's piece is right when its corners lie inside all planes of the other body; no
//     piece is missing when the vector areas add up to nothing.
//
// So a feature is never believed: what is not proved is left to overlap().
#pragma once
#include "dem/contact/overlap.h"

namespace trackbed::dem {

/// The kinds of overlap_simple.h; indices below 64, so that it fits an int.
struct SimpleFeature {
  enum Kind : int { none = 0, vertex_of_a = 1, vertex_of_b = 2, edges = 3 };
  int kind = none;
  /// Vertex: its index, the face. Edge: its vertex `from`, which of that vertex's edges.
  int a = 0, a_edge = 0, b = 0, b_edge = 0;

  int code() const { return kind | a << 2 | a_edge << 8 | b << 14 | b_edge << 20; }
  static SimpleFeature of(int code) {
    return {code & 3, code >> 2 & 63, code >> 8 & 63, code >> 14 & 63, code >> 20 & 63};
  }
};

/// As overlap(), for bodies whose overlap was bounded by these faces; `frame` need only have its
/// origin near the contact and its third axis near the normal. False when others bound it now, or
/// nothing overlaps.
bool overlap_again(const ConvexView& a, const Pose&, const ConvexView& b, const Pose&,
                   const ContactFrame&, const OverlapFeature&, OverlapWorkspace&, OverlapMoments&);

}  // namespace trackbed::dem
