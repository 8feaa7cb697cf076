// What is left of a contact when it opens.
#pragma once
#include "dem/contact/pairs.h"

namespace trackbed::dem {

inline void release(Pairs& pairs, int p) {
  if (!pairs.touching[p] && pairs.friction_loss[p] == 0) return;
  pairs.touching[p] = 0;
  pairs.feature[p] = pairs.faces_a[p] = pairs.faces_b[p] = 0;
  for (auto* v : {&pairs.friction, &pairs.force, &pairs.couple, &pairs.normal_force})
    (*v)[p].setZero();
  // What the tangential spring still held is lost with the contact.
  pairs.friction_loss[p] = pairs.friction_energy[p];
  for (auto* v : {&pairs.friction_stiffness, &pairs.energy, &pairs.friction_energy, &pairs.area,
                  &pairs.depth, &pairs.stiffness, &pairs.tilt_stiffness})
    (*v)[p] = 0;
}

}  // namespace trackbed::dem
