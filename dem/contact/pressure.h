// From overlap to force: the overlap as laws read it, and the exact integrals of a law's pressure
// p(x) = p0 + (x-c)^T Q (x-c) over the clipped pieces of one body's boundary.
//
// Over a triangle with corners y0, y1, y2 (relative to c) and q_ij = y_i^T Q y_j:
//   int y^T Q y dA     = A/6  sum_{i<=j} q_ij
//   int y^T Q y y dA   = A/10 sum_i y_i (q_ii + (2 q_ij + 2 q_ik + q_jj + q_kk + q_jk)/3)
// (Dirichlet's formula for polynomials over a simplex), so that no quadrature error enters the
// gradient of the stored energy.
#pragma once
#include "dem/contact/laws/pressure_law.h"
#include "dem/contact/overlap.h"

namespace trackbed::dem {

/// Central moments, vector area of a's pieces, and the extent of the pieces along the frame's
/// normal.
OverlapShape make_shape(const OverlapMoments&, const OverlapWorkspace&);

/// Frame axes. On body a acts -force with -moment about the overlap's centroid c.
struct PressureForce {
  Vec3 force = Vec3::Zero();   ///< int p n dA [N], n (acts_on only) outward from the pieces' body
  Vec3 moment = Vec3::Zero();  ///< int (x-c) x n p dA [N m]
};
PressureForce integrate_pressure(const OverlapWorkspace&, const std::vector<OverlapPiece>&,
                                 const OverlapShape&, const NormalResponse&);

/// The same over a fan of triangles around the first of n corners.
PressureForce integrate_pressure(const Vec3* corner, int n, const OverlapShape&,
                                 const NormalResponse&);

/// One piece: scalar moments of the pressure over it. With N linear on the piece's plane,
/// int p N n dA = n (N(c') zeroth + grad N . first), c' any point: first is taken about c.
struct PiecePressure {
  Vec3 normal = Vec3::Zero();      ///< unit, outward from the piece's body; zero for an empty piece
  double area = 0;                 ///< [m2]
  Vec3 area_first = Vec3::Zero();  ///< int (x-c) dA [m3]
  double zeroth = 0;               ///< int p dA [N]
  Vec3 first = Vec3::Zero();       ///< int p (x-c) dA [N m]
};
PiecePressure integrate_pressure(const OverlapWorkspace&, const OverlapPiece&, const OverlapShape&,
                                 const NormalResponse&);

/// int p N_i n dA over a piece that lies on the triangle `corner` (frame coordinates), N_i linear,
/// 1 at corner i. The three sum to the piece's force, and give its moment, to round-off.
struct NodalForces {
  Vec3 f[3];        ///< [N]
  double share[3];  ///< int N_i dA [m2]
};
NodalForces nodal_pressure(const OverlapWorkspace&, const OverlapPiece&, const OverlapShape&,
                           const NormalResponse&, const Vec3 corner[3]);

}  // namespace trackbed::dem
