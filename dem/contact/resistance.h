// What turns against each other at a contact meets: torsion about the normal, rolling about the
// tangents. A pass of its own over the touching pairs, after their forces and before the sums; a
// scene without it has none of its arrays and calls none of its code.
//
// Torsion, the Coulomb friction of a contact that has an area, held against its mean radius:
//   M_n <- M_n - k_n dtheta_n,  k_n = k_t A/(2 pi),  |M_n| <= t mu |F_n| rbar,
//   rbar = 2/3 sqrt(A/pi)                                                            [N m]
// for the disc of the overlap's area A (polar radius of gyration^2 A/(2 pi), mean radius rbar; a
// square's rbar is 1.7 % more). k_t as in friction.h, t the share asked for (1: Coulomb's).
//
// Rolling, the elastic-plastic spring of Ai, Chen, Rotter, Ooi, Powder Technology 206 (2011) 269,
// their model C without its dashpot (damping is another pass here):
//   M_r <- M_r - k_r dtheta_r,  |M_r| <= mu_r R |F_n|,  k_r = 2.25 k_n mu_r^2 R^2     [N m]
// R = r_a r_b/(r_a+r_b) of the distances contact to centre, or the grain's own at a rigid body; k_n
// the normal stiffness the law gives.
//
// dtheta: rotation of a less that of b over the step. Both moments turn with the pair, let go with
// shrinking contacts and make no energy, as friction does (advance_friction); what they store and
// dissipate is in the pairs' friction_energy and friction_loss.
#pragma once
#include "dem/contact/pair_forces.h"

namespace trackbed::dem {

struct ResistanceSettings {
  double torsion = 0;  ///< t, share of Coulomb's limit [-]; 0 = off
  double rolling = 0;  ///< mu_r [-]; 0 = off
  bool any() const { return torsion > 0 || rolling > 0; }
};

/// Adds both moments to Pairs::couple. `pairs` gets the arrays it needs on the first call. With
/// dt = 0 the moments stay as they are.
void add_resistance(const ResistanceSettings&, const Bodies&, const PairMaterials&,
                    const StepContext&, Pairs&);

}  // namespace trackbed::dem
