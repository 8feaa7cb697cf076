// What is left of a round contact when it opens.
#pragma once
#include "dem/contact/friction.h"
#include "dem/contact/release.h"
#include "dem/motion/motion.h"

namespace trackbed::dem {

/// What damping still took while the contact opened.
inline void release_round(const Bodies& b, const StepContext& c, Pairs& pairs, int p) {
  if (!pairs.touching[p] && pairs.friction_loss[p] == 0 && pairs.viscous_loss[p] == 0) return;
  double loss = 0;
  if (pairs.touching[p] && pairs.viscous[p] != 0 && c.dt > 0) {
    const int i = pairs.a[p], j = pairs.b[p];
    const ContactSlip slip = contact_slip(c.dt, b.v[i], b.turn[i], pairs.arm_a[p], pairs.arm_a[p],
                                          b.v[j], b.turn[j], pairs.arm_b[p], pairs.arm_b[p]);
    // It opened somewhere within the step: at most what the spring still held.
    const double way = pairs.axis[p].dot(slip.displacement);
    const double held = std::max(-pairs.depth[p], std::min(0.0, way));
    loss = pairs.viscous[p] * held / 2;
  }
  release(pairs, p);
  pairs.viscous[p] = 0;
  pairs.viscous_loss[p] = loss;
}

}  // namespace trackbed::dem
