// Two spheres that meet head on (Chung and Ooi 2011, test 1) and what collisions of spheres need.
#pragma once
#include "motion_scene.h"

namespace trackbed::dem {

struct Elastic {
  double E, nu;
  double modulus() const { return E / (1 - nu * nu); }                      // on a rigid body
  double ratio() const { return 2 * (1 - nu) / (2 - nu); }                  // k_t/k_n
  double stick(double mu) const { return mu * (2 - nu) / (2 * (1 - nu)); }  // tan of the angle
};

inline Scene sphere_scene(double modulus, double ratio, double mu, double e,
                          const std::string& law = "hertz_mindlin", double stiffness = 0) {
  Scene s(1, mu);
  PairMaterial m;
  m.modulus = modulus, m.friction = mu, m.tangential_ratio = m.round_ratio = ratio,
  m.stiffness = stiffness;
  m.damping = damping_for_restitution(law, e);
  s.materials.set(0, 0, m);
  s.round = make_round_forces(law, mu > 0);
  s.context.gravity.setZero();
  return s;
}

struct Impact {
  double depth = 0, force = 0, time = 0;
  Vec3 v, omega;
};

// Steps until the contact has opened; `time` of the contact, its ends within a step by the speed.
inline Impact collide(Scene& s) {
  Impact r;
  bool touched = false;
  double start = 0, end = 0, was = 0;
  s.prepare();
  for (long k = 0; k < 10000000; ++k) {
    s.step();
    const bool touching = count_contacts(s.pairs) > 0;
    if (!touching && touched) break;
    if (!touching) continue;
    const double depth = s.pairs.depth[0];
    const double speed = std::abs(depth - was) / s.context.dt;
    if (!touched) start = s.time - depth / (s.bodies.v[0] - s.bodies.v[1]).norm();
    end = s.time + (touched ? depth / speed : 0);
    touched = true;
    was = depth;
    r.depth = std::max(r.depth, depth);
    r.force = std::max(r.force, s.pairs.normal_force[0]);
  }
  r.time = end - start;
  r.v = s.bodies.v[0], r.omega = s.bodies.omega[0];
  return r;
}

inline constexpr double kImpactTime = 4.033945e-5;  ///< of test 1, by Hertz [s]

struct ImpactErrors {
  double rebound;  ///< of the speed afterwards: only touch and release err, order 5/2 for F ~ d^1.5
  double duration;  ///< of the contact, order 2
};

/// Test 1 (r 10 mm, ±10 m/s, E 48 GPa, ν .2, ρ 2800), elastic, `steps` a contact; relative errors,
/// the mean over eight sub-step phases of the first touch.
inline ImpactErrors impact_errors(int steps) {
  const Elastic m{48e9, .2};
  Scene s = sphere_scene(m.modulus() / 2, m.ratio(), 0, 1);
  s.context.dt = kImpactTime / steps;
  s.add(sphere_shape(.01), 2800, {-.01 - 1e-12, 0, 0});
  s.add(sphere_shape(.01), 2800, {.01, 0, 0});
  s.bodies.v[0].x() = 10, s.bodies.v[1].x() = -10;
  ImpactErrors e{0, 0};
  for (int phase = 0; phase < 8; ++phase) {
    Scene copy = s;
    copy.bodies.x[0].x() -= 20 * s.context.dt * (phase + .5) / 8;
    const Impact r = collide(copy);
    e.rebound += std::abs(r.v.x() + 10) / 80;
    e.duration += std::abs(r.time / kImpactTime - 1) / 8;
  }
  return e;
}

}  // namespace trackbed::dem
