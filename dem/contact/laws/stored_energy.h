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
// at most 0.98, a vertex (n=3, V=Sd/3) at most 0.95. The largest eigenvalue of -dF/dx over 2e4
// random pairs is 1.18 of it, so the bound given is 1.2 x 2 c E sqrt(|S|).
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

  // C = D R D with D = diag(sqrt(C_ii)): flat overlaps, C_zz << C_xx, keep their digits.
  const double ex = 1 / std::sqrt(C(0, 0)), ey = 1 / std::sqrt(C(1, 1)),
               ez = 1 / std::sqrt(C(2, 2));
  const double xy = C(0, 1) * ex * ey, xz = C(0, 2) * ex * ez, yz = C(1, 2) * ey * ez;
  const double mxx = 1 - yz * yz, myy = 1 - xz * xz, mzz = 1 - xy * xy;
  const double mxy = xz * yz - xy, mxz = xy * yz - xz, myz = xy * xz - yz;
  const double det = mxx + xy * mxy + xz * mxz;
  if (!(det > 0)) return r;

  Mat3 K;  // C^-1 times det
  K(0, 0) = mxx * ex * ex, K(1, 1) = myy * ey * ey, K(2, 2) = mzz * ez * ez;
  K(0, 1) = K(1, 0) = mxy * ex * ey, K(0, 2) = K(2, 0) = mxz * ex * ez;
  K(1, 2) = K(2, 1) = myz * ey * ez;
  const double size = P == 1 ? K.trace() : K.norm();
  K *= 1 / size;  // lambda C^-1
  const double lambda = det / size;
  if (!(lambda > 0)) return r;

  constexpr double c = 0.37612638903183752462;  // 2/(3 sqrt(pi))
  const double thickness2 = 12 * lambda / s.volume;
  const double thickness = std::sqrt(thickness2);
  r.energy = c * modulus * thickness * std::sqrt(s.volume * thickness);
  r.p0 = -0.25 * r.energy / s.volume;
  const Mat3 K2 = K * K;
  r.Q = 0.75 * r.energy / lambda * (P == 1 ? K2 : Mat3(K2 * K));
  r.stiffness = 1.2 * 2 * c * modulus * std::sqrt(s.area.norm());
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
