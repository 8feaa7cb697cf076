// Inside overlap(): the ways to the pieces. clip_small keeps polygons in registers and takes
// pairs whose bodies have at most 64 vertices and faces and whose polygons have at most eight
// corners; clip_any takes every pair. Same method, same pieces to round-off. clip_closed is for the
// few pairs whose pieces do not close.
#pragma once
#include "dem/contact/overlap.h"

namespace trackbed::dem {

/// A body in frame coordinates: p = M p_body + t.
struct PlacedBody {
  const ConvexView& view;
  Mat3 M;
  Vec3 t;
};

/// The common slab, a little enlarged so that no clip falls on its planes. The cut that is kept of
/// a lies above `a`, that of b below `b`.
struct SlabCut {
  bool overlap;
  double a = 0, b = 0;
  double slack = 0;  ///< planes that miss the other part by more than this [m] cannot matter

  /// `high` a's highest, `low` b's lowest point along the normal.
  SlabCut(const PlacedBody& body_a, const PlacedBody& body_b, double high, double low) {
    const double ra = body_a.view.radius, rb = body_b.view.radius;
    const double depth = high - low;
    overlap = depth > 1e-15 * (ra < rb ? ra : rb);
    a = low - 1e-3 * depth;
    b = high + 1e-3 * depth;
    slack = 1e-13 * (ra + rb);
  }
};

/// Appends a polygon of n corners as a piece.
inline void add_piece(int face, int n, const double* x, const double* y, const double* z,
                      OverlapWorkspace& work, std::vector<OverlapPiece>& pieces) {
  const std::size_t first = work.points.size();
  work.points.resize(first + n);
  Vec3* p = work.points.data() + first;
  for (int i = 0; i < n; ++i) p[i] = Vec3(x[i], y[i], z[i]);
  double ax = 0, ay = 0, az = 0;  // twice the vector area
  double ux = x[1] - x[0], uy = y[1] - y[0], uz = z[1] - z[0];
  for (int i = 2; i < n; ++i) {
    const double vx = x[i] - x[0], vy = y[i] - y[0], vz = z[i] - z[0];
    ax += uy * vz - uz * vy, ay += uz * vx - ux * vz, az += ux * vy - uy * vx;
    ux = vx, uy = vy, uz = vz;
  }
  pieces.push_back({face, static_cast<int>(first), n, Vec3(0.5 * ax, 0.5 * ay, 0.5 * az)});
}

/// tetrahedron: four triangles, the corners are points 0, 1, 2 and 5 of those appended, and the
/// first triangle is 0, 1, 2. too_large: pieces may have been appended and must be taken back.
enum class Clipped { nothing, pieces, tetrahedron, too_large };

/// By the faces of a feature; notes those of the result in the workspace. False when they are not
/// what bounds the overlap; pieces may have been appended then.
bool clip_faces(const PlacedBody& a, const PlacedBody& b, const OverlapFeature&, OverlapWorkspace&);

Clipped clip_small(const PlacedBody& a, const PlacedBody& b, OverlapWorkspace&);

/// False when nothing overlaps for certain.
bool clip_any(const PlacedBody& a, const PlacedBody& b, OverlapWorkspace&);

/// Pieces that close whatever rounding does; slow, allocates. Faces that coincide are a's.
void clip_closed(const PlacedBody& a, const PlacedBody& b, OverlapWorkspace&);

}  // namespace trackbed::dem
