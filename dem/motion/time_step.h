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
#include <string>
#include <vector>

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
  double overlap = 0.005;   ///< round contacts: overlap / bounding radius of the grain
  bool flat_faces = false;  ///< those of dilated grains answer by their area (RoundForces)
};

/// A priori, for one grain on its neighbours:
///   k = kappa_n E sqrt(share A_face), omega^2 = 2 N k (1 + 2 kappa)/3 (1/m + r^2/(2 I_min)),
/// E the largest modulus of the grain's material against any other, A_face its largest face, r its
/// bounding radius, kappa the tangential ratio when there is friction. Held bodies do not count.
/// Spheres, clumps and dilated grains: k = 2 E sqrt(R overlap r), R the part's radius (Hertz), or
/// the linear law's k; one crowned face more that rolls, with F/crown; flat faces that answer by
/// their area as those of polyhedra.
TimeStepLimit expected_limit(const Bodies&, const ShapeTable&, const PairMaterials&,
                             const ContactExpectation&);

/// Rules of the field, by name; none is a limit: compare with one.
/// sun2015: T_min/40, T_min = 2 pi sqrt(m/k) of the lightest grain (Sun et al. 2015, Eq. 12), k as
/// in expected_limit.
/// rayleigh: the time a Rayleigh wave takes over the smallest grain,
///   pi r sqrt(rho/G)/(0.1631 nu + 0.8766),
/// r of the sphere of its volume, nu = 0.3, G = E/(2(1+nu)); E is the contact modulus, that of
/// round contacts taken as E* of two alike, E/(2(1-nu^2)).
/// Throws InputError naming the rules for any other name.
double rule_of_thumb(const std::string& rule, const Bodies&, const ShapeTable&,
                     const PairMaterials&, const ContactExpectation& = {});

/// A contact's share in the sum above for the body at its end: `split` is s_c, `arm` from the
/// body's centre to the contact point [m], `normal` a unit vector, `tilt` about the tangents [N m].
struct ContactShare {
  double split, normal_stiffness, friction_stiffness, tilt;
  Vec3 normal, arm;
};

/// Contacts of bodies besides the pairs (with deforming surfaces).
struct FurtherContacts {
  std::vector<int> first;  ///< body i's: [first[i], first[i+1]); empty: there are none
  std::vector<ContactShare> contact;
};

/// From the contacts of the last evaluation, by the bound above.
TimeStepLimit measured_limit(const Bodies&, const Pairs&, int threads, const FurtherContacts& = {});

}  // namespace trackbed::dem
