// Inside clip_small: the two commonest overlaps need no polygon clipping.
//
//   vertex in face: vertex v of one body inside the other, all its edges leave through one plane:
//     the overlap is the cone from v to the points where they do.
//   edge on edge: an edge of a enters and leaves b through b's faces j, k; their common edge enters
//     and leaves a through the two faces at a's edge: the overlap is the tetrahedron of the four
//     points.
//
// In both the points lie in both bodies, and the planes named bound nothing larger: so the overlap
// is exact. When neither holds, a plane is met at a grazing angle, or the points are not clear of
// each other's planes by more than rounding (a tetrahedron turned inside out), the caller clips
// polygons.
#pragma once
#include "dem/contact/overlap_clip.h"
#include "dem/contact/overlap_feature.h"

namespace trackbed::dem {

constexpr int kMost = 64;

// Rounding of distances is about 1e-16 of the size: a rise above 1e-6 of it keeps crossings to
// 1e-10 of an edge, and what is clear by 1e-13 is certain.
constexpr double kLeastRise = 1e-6, kClear = 1e-7;  // the latter of the former

/// A bit for each face of a body of at most 64.
inline std::uint64_t face_bits(const ConvexView& v) {
  return v.faces >= 64 ? ~std::uint64_t(0) : (std::uint64_t(1) << v.faces) - 1;
}

/// A body of at most 64 vertices and faces in frame coordinates, and its part in the slab.
struct Side {
  alignas(64) double x[kMost], y[kMost], z[kMost];                    // vertices
  alignas(64) double nx[kMost], ny[kMost], nz[kMost], offset[kMost];  // planes
  alignas(64) double px[4 * kMost], py[4 * kMost], pz[4 * kMost];     // corners of the slab's part
  int corners = 0;
  std::uint64_t kept = 0;   // vertices in the slab
  std::uint64_t faces = 0;  // those that reach into the slab, then those that may matter
  double high = 0, low = 0;
};

/// Appends the pieces, notes the feature in the workspace, and returns `tetrahedron` or `pieces` if
/// the overlap is one of the two kinds, else `nothing`. The faces are to be culled first: it looks
/// at every edge between them.
Clipped clip_simple(const PlacedBody& a, const Side&, const PlacedBody& b, const Side&,
                    OverlapWorkspace&);

}  // namespace trackbed::dem
