// What the flat faces of dilated polyhedra add to their deepest balls: where two faces lie almost
// parallel the bodies do not touch at a point but over an area.
//
// The flat part of a body at a face is the prism of height r on it (face_prism.h); of a plain
// polyhedron it is all of the body. Prisms overlap in exactly the part of the bodies' overlap that
// belongs to flat faces of both. That overlap answers by the law of polyhedra,
// laws/stored_energy.h: an energy U(V, C) with a continuous gradient, so that the sum with that of
// the deepest balls is one too; face on face its force is 4E sqrt(A) d/(3 sqrt(pi)), that of plain
// polyhedra and of Eq. 17 of Shao, Lian, Yang 2017. It is gone by itself where a face is tilted
// away: a point of a prism on a face with normal m is at most r n.m farther along n than the core,
// so that nothing overlaps once
//   n.m <= 1 - delta/r,   n the direction of the deepest balls, delta what they overlap by without
//                         the crowns.
// So most contacts cost one look at the normals.
#pragma once
#include "dem/contact/deepest_balls.h"
#include "dem/contact/normal_contact.h"

namespace trackbed::dem {

/// As deepest_balls() of two polyhedra, one of them dilated (ShapeTable::flat_part), `balls` its
/// result; the centroid is from a's centre. False when no flat parts overlap.
bool flat_contact(const PartView& a, const Mat3& Ra, const PartView& b, const Pose&,
                  const DeepestBalls& balls, const PairMaterial&, OverlapWorkspace&,
                  NormalContact&);

}  // namespace trackbed::dem
