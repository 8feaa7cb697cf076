// A body that turns freely about its middle axis: the flip's period.
#pragma once
#include "motion_scene.h"

namespace trackbed::dem {

inline Bodies one_body(const Vec3& inertia, const Vec3& omega, const Quat& q = Quat::Identity()) {
  Bodies b;
  add_body(b, 0, 0, 1, inertia, Vec3::Zero(), q, kFree);
  b.grains = 1;
  set_spin(b, 0, q * omega);
  return b;
}

inline Vec3 spin_in_body(const Bodies& b) { return b.R[0].transpose() * b.omega[0]; }

inline StepContext context(double dt) {
  StepContext c;
  c.dt = dt;
  c.gravity.setZero();
  return c;
}

inline constexpr double kFlipPeriod = 39.105734197;  ///< of flip_period(), in closed form [s]

/// Time between two passes of the middle component of the spin through 0 in the same sense [s], for
/// I = (1, 2, 3) and a spin of (.01, 1, .01), steps of dt.
inline double flip_period(double dt) {
  Bodies b = one_body({1, 2, 3}, {.01, 1, .01});
  const StepContext c = context(dt);
  double before = 1, first = -1;
  for (long k = 1;; ++k) {
    drift(b, c), kick(b, c);
    const double now = spin_in_body(b).y();
    if (before > 0 && now <= 0) {
      const double t = (k - 1 + before / (before - now)) * dt;
      if (first >= 0) return t - first;
      first = t;
    }
    before = now;
    if (k * dt > 200) return NAN;
  }
}

}  // namespace trackbed::dem
