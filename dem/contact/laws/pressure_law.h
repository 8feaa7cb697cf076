// What a normal contact law returns: its stored energy and the pressure it puts on the overlap's
// boundary. All laws are pressure laws, p(x) = p0 + (x-c)^T Q (x-c), so that grain on grain and
// grain on deforming surface share one integration: force on a = -int p n dA over a's pieces.
// A law whose force has a given direction lets the pressure act on projected areas only.
#pragma once
#include "dem/contact/overlap.h"

namespace trackbed::dem {

/// 4/(3 sqrt(pi)) of Shao 2017 Eq. 17.
inline constexpr double kShaoFactor = 0.75225277806367504925;

/// Constants of one pair of materials, mixed when the pair of materials is made.
struct PairMaterial {
  double modulus = 0;           ///< E of Shao 2017 Eq. 17 [Pa]; two bodies: 2 E1 E2/(E1+E2)
  double friction = 0;          ///< Coulomb coefficient
  double tangential_ratio = 0;  ///< k_s/k_n (Shao 2017: 0.25)
  // Of the ball laws only (ball_law.h), which take `modulus` as the contact's E*.
  double damping = 0;             ///< alpha of the law's damping [-] (restitution.h); 0 = none
  double stiffness = 0;           ///< k of the linear law [N/m]
  double round_ratio = 14. / 17;  ///< k_t/k_n, Mindlin's 2(1-nu)/(2-nu) at nu = 0.3
};

/// The overlap as a law reads it, frame axes, centroid relative to the frame's origin.
struct OverlapShape {
  double volume;       ///< V [m3]
  Vec3 centroid;       ///< [m]
  Mat3 second_moment;  ///< C = int (x-c)(x-c)^T dV [m5]
  Vec3 area;           ///< vector area of a's pieces, int n dA [m2] (outward from a)
  double depth;        ///< extent along the frame's normal [m]
};

struct NormalResponse {
  double energy = 0;      ///< U [J]; 0 for laws without a stored energy
  double p0 = 0;          ///< [Pa]
  Mat3 Q = Mat3::Zero();  ///< [Pa/m2]
  /// Components of n dA that the pressure acts on, frame axes: all, or (0,0,1), along the normal.
  Vec3 acts_on = Vec3::Ones();
  double stiffness = 0;  ///< estimate of dF/d(depth) [N/m], for the time step
};

}  // namespace trackbed::dem
