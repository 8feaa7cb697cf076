// The largest stable time step, 2/omega_max, of velocity Verlet.
//
// Bound: for contacts c with stiffness K_c between bodies a and b, (x+y)^2 <= 2x^2 + 2y^2 splits
// the stiffness over the bodies, so that
//   omega_max^2 <= max over bodies of the largest eigenvalue of
//                  sum over its contacts of s_c M^-1/2 B_c^T K_c B_c M^-1/2,
// B_c: velocity and spin of the body to the velocity of the contact point; s_c = 2, or 1 when the
// other body is held; K_c = k_n n n^T + k_t (I - n n^T), and Pairs::tilt_stiffness about the
// tangents. Translation, rotation and friction in one.
#pragma once
#include "dem/contact/pair_forces.h"

namespace trackbed::dem {

struct TimeStepLimit {
  double dt = 0;     ///< 2/omega [s]; infinite when nothing is touched or expected to be
  int body = -1;     ///< whose bound is the worst
  double omega = 0;  ///< [rad/s]
  int contacts = 0;  ///< of that body
};

/// What a scene expects of its contacts before there are any.
struct ContactExpectation {
  double area_share = 0.1;  ///< largest contact area / largest face of the grain
  double contacts = 6;      ///< as stiff as that, at one grain
};

/// A priori, for one grain on its neighbours:
///   k = kappa_n E sqrt(share A_face), omega^2 = 2 N k (1 + 2 kappa)/3 (1/m + r^2/(2 I_min)),
/// E the largest modulus of the grain's material against any other, A_face its largest face, r its
/// bounding radius, kappa the tangential ratio when there is friction. Held bodies do not count.
TimeStepLimit expected_limit(const Bodies&, const ShapeTable&, const PairMaterials&,
                             const ContactExpectation&);

/// From the contacts of the last evaluation, by the bound above.
TimeStepLimit measured_limit(const Bodies&, const Pairs&, int threads);

}  // namespace trackbed::dem
