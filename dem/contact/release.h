// What is left of a contact when it opens.
#pragma once
#include "dem/contact/pairs.h"

namespace trackbed::dem {

/// A pair that is apart by `gap` > 0 sleeps until its bodies may have come so far. One that touched
/// until now is looked at once more: what it lost as it opened belongs to this step alone.
inline void sleep(const std::vector<double>& travel, double gap, Pairs& pairs, int p) {
  if (!pairs.touching[p]) pairs.wake[p] = travel[pairs.a[p]] + travel[pairs.b[p]] + gap;
}

inline bool asleep(const std::vector<double>& travel, const Pairs& pairs, int p) {
  return travel[pairs.a[p]] + travel[pairs.b[p]] < pairs.wake[p];
}

inline void release(Pairs& pairs, int p) {
  if (!pairs.touching[p] && pairs.friction_loss[p] == 0) return;
  pairs.touching[p] = 0;
  pairs.feature[p] = pairs.faces_a[p] = pairs.faces_b[p] = 0;
  for (auto* v : {&pairs.friction, &pairs.force, &pairs.couple}) (*v)[p].setZero();
  // What the tangential spring still held is lost with the contact.
  pairs.friction_loss[p] = pairs.friction_energy[p];
  for (auto* v :
       {&pairs.friction_stiffness, &pairs.energy, &pairs.friction_energy, &pairs.normal_force,
        &pairs.area, &pairs.depth, &pairs.stiffness, &pairs.tilt_stiffness})
    (*v)[p] = 0;
}

}  // namespace trackbed::dem
