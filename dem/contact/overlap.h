// Overlap of two convex polyhedra by clipping: volume, moments, and the pieces of both
// boundaries that bound it. Everything is computed in a contact frame whose third axis is the
// expected normal, so that flat overlaps (depth 1e-9 of the contact's width) keep their digits.
#pragma once
#include <vector>

#include "dem/contact/shape_table.h"
#include "dem/types.h"

namespace trackbed::dem {

struct Pose {
  Mat3 R;  ///< body -> world
  Vec3 x;  ///< world position of the body's origin [m]
};

/// Local frame of a contact: p_world = origin + axes * p_local; axes.col(2) is the expected
/// normal, from body a to body b. It steers culling and conditioning, never the exact result.
struct ContactFrame {
  Vec3 origin;
  Mat3 axes;
};

/// A polygon of one body's face inside the other body: points [first, first+count) of
/// OverlapWorkspace::points, in frame coordinates, counter-clockwise seen from outside that body;
/// `area` is its vector area (outward from the body it belongs to).
struct OverlapPiece {
  int face;
  int first, count;
  Vec3 area;
};

/// Scratch of one thread; no allocation once warm.
struct OverlapWorkspace {
  std::vector<Vec3> points;
  std::vector<OverlapPiece> a_pieces, b_pieces;
};

/// Moments of the overlap about the frame's origin, in frame axes: volume [m3], first [m4],
/// second int x x^T dV [m5]. They add up over the cells of a shell.
struct OverlapMoments {
  double volume = 0;
  Vec3 first = Vec3::Zero();
  Mat3 second = Mat3::Zero();
};

/// Unit direction from a to b along which the bodies are separated, or the best one found while
/// they overlap; starts from `axis` (the pair's cached one, any length incl. zero). Returns the gap
/// along it [m]: positive = separated for certain.
double separating_axis(const ConvexView& a, const Pose&, const ConvexView& b, const Pose&,
                       Vec3& axis);

/// A frame for the pair with third axis `axis`, origin in the middle of the bodies' common slab.
ContactFrame contact_frame(const ConvexView& a, const Pose&, const ConvexView& b, const Pose&,
                           const Vec3& axis);

/// Clips a's faces by b's planes and b's by a's. Appends to the workspace's pieces (the caller
/// clears it) and adds to `moments`. False when the bodies do not overlap.
bool overlap(const ConvexView& a, const Pose&, const ConvexView& b, const Pose&,
             const ContactFrame&, OverlapWorkspace&, OverlapMoments& moments);

}  // namespace trackbed::dem
