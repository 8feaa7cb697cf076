// What the laws of contacts between balls take and give: spheres, spheres of clumps, and the balls
// that a dilated polyhedron consists of. The contact is two balls, radii r_a and r_b about points x
// and y; overlap delta = r_a + r_b - |y - x|.
//
// The elastic force is a function of delta alone, F = dU/d(delta), along y - x: a gradient. Damping
// adds c d(delta)/dt; the sum never pulls. It takes the approach speed at the step's end, which the
// force itself still changes by F dt/(2m): solved for F,
//   F = max(0, (F_el + c v)/(1 + c dt/(2m))),   v the speed at mid-step, m = 1/(1/m_a + 1/m_b),
// so that damping is of second order in time and stable at any step.
#pragma once
#include <algorithm>

#include "dem/contact/laws/pressure_law.h"

namespace trackbed::dem {

struct BallContact {
  double overlap;  ///< delta > 0 [m]
  double radius;   ///< R* = 1/(1/r_a + 1/r_b), that of a for a flat b [m]
  double rate;     ///< d(delta)/dt at mid-step [m/s]
  double mass;     ///< m [kg]
  double dt;       ///< [s]
};

struct BallResponse {
  double energy = 0;      ///< U [J]
  double elastic = 0;     ///< dU/d(delta) [N]
  double force = 0;       ///< with damping, >= 0 [N]
  double stiffness = 0;   ///< d2U/d(delta)2 [N/m]
  double tangential = 0;  ///< [N/m]
};

/// Total force of an elastic one and a damper c [N s/m].
inline double damped(double elastic, double c, const BallContact& b) {
  return std::max(0.0, (elastic + c * b.rate) / (1 + c * b.dt / (2 * b.mass)));
}

}  // namespace trackbed::dem
