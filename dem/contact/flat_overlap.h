// The overlap of two flat parts (face_prism.h) that meet by little.
//
// A prism's base is as far below its outer face as the radius is high, and what overlaps is thinner
// by far: so only the outer faces and the uppermost strips of the walls are looked at, one face and
// a wall for each of its edges, eight corners at a time. Strips that lie outside one plane of the
// other prism, and planes that cut nothing, drop out by the signs of the corners' distances; of the
// rest mostly a handful is clipped. A plain polyhedron stands here for the half space below its
// face, where none of its other faces is near.
#pragma once
#include "dem/contact/overlap_clip.h"

namespace trackbed::dem {

/// A face and the flat part of the body on it, the k-th of its prisms of that height (prisms_of()
/// with kFlatCorners); of a plain polyhedron, height 0, all that lies below.
struct FlatFace {
  int face;
  double height;
  int prism = 0;
};
inline constexpr int kFlatCorners = 7;

/// As overlap() of the flat parts at two faces, for what is thinner than `thickness` [m] along both
/// faces' normals and far thinner than the prisms are high. `unsure` where only overlap() can tell
/// (flat_overlap.h); pieces and moments are then as before.
enum class FlatOverlap { nothing, found, unsure };
FlatOverlap overlap_of_faces(const ConvexView& a, const Pose&, const FlatFace&, const ConvexView& b,
                             const Pose&, const FlatFace&, const ContactFrame&, double thickness,
                             OverlapWorkspace&, OverlapMoments& moments);

/// The pieces of overlap_of_faces(). False: it cannot be told this way (walls of both that may
/// coincide, faces of more than eight corners, a plain polyhedron's edge), the caller takes
/// another. Pieces may have been appended then.
bool clip_flats(const PlacedBody& a, const FlatFace& on_a, const PlacedBody& b,
                const FlatFace& on_b, double thickness, OverlapWorkspace&);

}  // namespace trackbed::dem
