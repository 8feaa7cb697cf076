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
#include "dem/contact/eight.h"
#include "dem/contact/laws/pressure_law.h"

namespace trackbed::dem {

/// Of one contact (Number double) or eight (Eight).
template <class Number>
struct BallContactOf {
  Number overlap;  ///< delta > 0 [m]
  Number radius;   ///< R* = 1/(1/r_a + 1/r_b), that of a for a flat b [m]
  Number rate;     ///< d(delta)/dt at mid-step [m/s]
  Number mass;     ///< m [kg]
  double dt;       ///< [s]
};

/// What these laws read of PairMaterial.
template <class Number>
struct BallMaterialOf {
  Number modulus, friction, damping, stiffness, round_ratio;
};
inline BallMaterialOf<double> ball_material(const PairMaterial& m) {
  return {m.modulus, m.friction, m.damping, m.stiffness, m.round_ratio};
}

template <class Number>
struct BallResponseOf {
  Number energy;      ///< U [J]
  Number elastic;     ///< dU/d(delta) [N]
  Number force;       ///< with damping, >= 0 [N]
  Number stiffness;   ///< d2U/d(delta)2 [N/m]
  Number tangential;  ///< [N/m]
};

/// Total force of an elastic one and a damper c [N s/m].
template <class Number>
Number damped(const Number& elastic, const Number& c, const BallContactOf<Number>& b) {
  const Number zero = 0, force = (elastic + c * b.rate) / (1 + 0.5 * b.dt * c / b.mass);
  return where_less(zero, force, force, zero);
}

}  // namespace trackbed::dem
