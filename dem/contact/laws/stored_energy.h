// The default normal law: the gradient of a stored energy, so that a closed loop does no work.
//
//   U = c E sqrt(V) dbar^(3/2),   c = 2/(3 sqrt(pi)),   dbar^2 = 12 lambda/V,
//   lambda = (tr C^-2)^(-1/2),    C = int (x-xc)(x-xc)^T dV over the overlap             [J]
//
// V volume of the overlap [m3], E modulus [Pa], C its central second moment [m5], dbar its smooth
// thickness [m]: a slab a x b x d has dbar^-4 = a^-4 + b^-4 + d^-4. Moving a boundary element by
// delta along its outward normal changes U by p delta dA,
//
//   p(x) = -U/(4V) + 3/4 U lambda^2 (x-xc)^T C^-3 (x-xc)                                  [Pa]
//
// (dU = U(-1/4 dV/V + 3/4 dlambda/lambda), dlambda = lambda^3 tr(C^-3 dC), dV = delta dA,
// dC = (x-xc)(x-xc)^T delta dA), hence force on a = -int p n dA over a's faces inside b.
//
// Face on face, U = c E sqrt(A) d^2 and F = 2 c E sqrt(A) d = 4E sqrt(V d)/(3 sqrt(pi)), which is
// Eq. 17 of Shao, Lian, Yang 2017.
//
// Stiffness, for the time step: with the shape kept, U grows as d^n and dF/dd = n(n-1) U/d^2; in
// units of 2 c E sqrt(S), S the contact's area, a face (n=2, V=Sd) has 1, an edge (n=5/2, V=Sd/2)
// at most 0.98, a vertex (n=3, V=Sd/3) at most 0.95. Over 2e4 random
// pairs the stiffness along the force is at most 1.18 of it, so 1.2 x 2 c E sqrt(|S|) is given: a
// measured bound, not a proven one (largest eigenvalue of -dF/dx over 2000 pairs: 0.98 of it).
//
// Why this member of lambda = (tr C^-P)^(-1/P). P -> infinity is the least thickness, with a kink
// at tilt zero (a resting cube chatters). P = 1 and 2 are smooth (contact_law_test):
//                      P = 1      P = 2
//   Eq. 17 at d/a = 0.1   -2.9e-2    -2.3e-4     error O((d/a)^2) against O((d/a)^4)
//   Eq. 17 at a vertex     0.61       0.79       of a cube
//   tilt stiffness         2.24       2.24       of a Winkler bed with k_n/A per area
//   least/largest p       -0.034     -0.026      a cube's vertex: thin rims pull slightly
#pragma once
#include <cmath>

#include "dem/contact/laws/pressure_law.h"

namespace trackbed::dem {

/// The family lambda = (tr C^-P)^(-1/P), p(x) = -U/(4V) + 3/4 U lambda^P (x-xc)^T C^-(P+1) (x-xc).
template <int P>
NormalResponse stored_energy_response(const OverlapShape& s, double modulus) {
  static_assert(P == 1 || P == 2, "trace or Frobenius norm");
  NormalResponse r;
  const Mat3& C = s.second_moment;
  if (!(s.volume > 0) || !(C(0, 0) > 0) || !(C(1, 1) > 0) || !(C(2, 2) > 0)) return r;

  // C^-1 det R, where C = D R D with D = diag(sqrt(C_ii)): scaled by the diagonal, flat overlaps,
  // C_zz << C_xx, keep their digits.
  const double ix = 1 / C(0, 0), iy = 1 / C(1, 1), iz = 1 / C(2, 2);
  const double ux = C(1, 2) * iy, uy = C(0, 2) * iz, uz = C(0, 1) * ix;
  const double rx = ux * C(1, 2) * iz, ry = uy * C(0, 2) * ix, rz = uz * C(0, 1) * iy;  // R_ij^2
  double det = (1 - rx) - ry - rz + 2 * ux * uy * uz;
  if (det < 1e-10) {  // a needle across the axes: by elimination its least thickness keeps its digits
    const double left = C(1, 2) - C(0, 1) * C(0, 2) * ix;
    det = (1 - ry) * (1 - rz) - left * iy * left * iz;
  }
  if (!(det > 0)) return r;
  double xx = (1 - rx) * ix, yy = (1 - ry) * iy, zz = (1 - rz) * iz;
  double xy = (uy * C(1, 2) - C(0, 1)) * ix * iy, xz = (ux * C(0, 1) - C(0, 2)) * ix * iz;
  double yz = (uz * C(0, 2) - C(1, 2)) * iy * iz;
  const double size =
      P == 1 ? xx + yy + zz
             : std::sqrt(xx * xx + yy * yy + zz * zz + 2 * (xy * xy + xz * xz + yz * yz));
  const double lambda = det / size, scale = 1 / size;  // K = lambda C^-1 from here on
  if (!(lambda > 0)) return r;
  xx *= scale, yy *= scale, zz *= scale, xy *= scale, xz *= scale, yz *= scale;

  constexpr double c = 0.37612638903183752462;  // 2/(3 sqrt(pi))
  const double inverse = 1 / s.volume;
  const double thickness = std::sqrt(12 * lambda * inverse);
  r.energy = c * modulus * thickness * std::sqrt(s.volume * thickness);
  r.p0 = -0.25 * r.energy * inverse;
  r.stiffness = 1.2 * 2 * c * modulus * std::sqrt(s.area.norm());

  // Q = 3/4 U/lambda K^(P+1), symmetric.
  double qxx = xx * xx + xy * xy + xz * xz, qyy = xy * xy + yy * yy + yz * yz;
  double qzz = xz * xz + yz * yz + zz * zz, qxy = xx * xy + xy * yy + xz * yz;
  double qxz = xx * xz + xy * yz + xz * zz, qyz = xy * xz + yy * yz + yz * zz;
  if (P == 2) {
    const double sxx = qxx, syy = qyy, szz = qzz, sxy = qxy, sxz = qxz, syz = qyz;
    qxx = sxx * xx + sxy * xy + sxz * xz, qyy = sxy * xy + syy * yy + syz * yz;
    qzz = sxz * xz + syz * yz + szz * zz, qxy = sxx * xy + sxy * yy + sxz * yz;
    qxz = sxx * xz + sxy * yz + sxz * zz, qyz = sxy * xz + syy * yz + syz * zz;
  }
  const double q = 0.75 * r.energy / lambda;
  r.Q << q * qxx, q * qxy, q * qxz, q * qxy, q * qyy, q * qyz, q * qxz, q * qyz, q * qzz;
  return r;
}

struct StoredEnergyLaw {
  static constexpr const char* name = "stored_energy";
  static constexpr bool stores_energy = true;
  NormalResponse operator()(const OverlapShape& s, const PairMaterial& m) const {
    return stored_energy_response<2>(s, m.modulus);
  }
};

}  // namespace trackbed::dem
