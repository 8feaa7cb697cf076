// The overlap of two flat parts (face_prism.h) where the one dips into the middle of the other's
// outer face: by a corner, an edge or all of its own, which is how most of them meet.
//
// The dipping prism's part below that face's plane is the hull of the corners below (tips), of the
// points where the walls' edges through them cross the plane, and of those where the outer face's
// border does. Where all these points lie inside the other's walls, that hull is the overlap. Its
// moments are cones from one tip, of which the pieces through it, most of all, are nothing; the
// law's pressure is integrated over the one piece in the plane.
#pragma once
#include "dem/contact/flat_overlap.h"
#include "dem/contact/simple_contact.h"

namespace trackbed::dem {

/// As overlap_of_faces(), places about a's centre; thinner than either prism is high. `unsure`: they
/// meet otherwise.
FlatOverlap flat_cap(const ConvexView& a, const Mat3& Ra, const FlatFace&, const ConvexView& b,
                     const Pose&, const FlatFace&, SimpleContact&);

}  // namespace trackbed::dem
