// Two dilated polyhedra, placed by hand.
#pragma once
#include <algorithm>

#include "motion_scene.h"

namespace trackbed::dem::test {

/// Puts body i there. No pair may sleep on: nothing was moved by a step. Forces are those of the
/// next prepare().
inline void place(Scene& s, int i, const Vec3& x, const Mat3& R) {
  std::fill(s.pairs.wake.begin(), s.pairs.wake.end(), 0.0);
  s.bodies.x[i] = x;
  s.bodies.R[i] = R;
  s.bodies.q[i] = Quat(R).normalized();
}

}  // namespace trackbed::dem::test
