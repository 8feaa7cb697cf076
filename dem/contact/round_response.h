// What a round contact answers with, between two grains (Pairs) and between a grain and a surface
// (PatchContacts) alike: their arrays have the same names.
#pragma once
#include <cmath>

#include "dem/contact/friction.h"
#include "dem/contact/laws/ball_law.h"
#include "dem/motion/bodies.h"

namespace trackbed::dem {

/// 1/(1/a + 1/b); 0 is flat.
inline double mean_radius(double a, double b) { return b > 0 && a > 0 ? a * b / (a + b) : a + b; }

/// m of BallContactOf: a body that is held has no part in it.
inline double contact_mass(const Bodies& b, int i, int j) {
  return b.freedom[j] == kFixed   ? b.mass[i]
         : b.freedom[i] == kFixed ? b.mass[j]
                                  : b.mass[i] * b.mass[j] / (b.mass[i] + b.mass[j]);
}

/// V: Vec3 for one contact, Eight3 for eight.
template <class V>
struct RoundAnswer {
  using Number = NumberOf<V>;
  BallResponseOf<Number> law;
  V force, normal;           ///< on a, with and without friction [N]
  Number viscous_loss;       ///< of this step [J]
  FrictionOf<Number> slide;  ///< energies of the tangential spring
};

/// Law, damping and friction of a contact over the step; advances its history: damping force,
/// tangential force, stiffness. n unit, from a to b.
template <class Law, bool friction, class V>
[[gnu::always_inline]] inline RoundAnswer<V> round_answer(
    const BallMaterialOf<NumberOf<V>>& material, const BallContactOf<NumberOf<V>>& contact,
    const V& n, const SlipOf<V>& slip, NumberOf<V>& viscous, V& tangential,
    NumberOf<V>& tangential_stiffness) {
  RoundAnswer<V> r;
  r.law = Law()(contact, material);
  r.normal = -1. * r.law.force * n;
  const NumberOf<V> now = r.law.force - r.law.elastic;
  r.viscous_loss = 0.5 * (viscous + now) * dot(n, slip.displacement);
  viscous = now;
  r.force = r.normal;
  if constexpr (friction) {
    r.slide = advance_friction(material.friction, r.law.tangential, n, r.law.force, slip,
                               tangential, tangential_stiffness);
    r.force = r.force + tangential;
  }
  return r;
}

/// The same of contact i: writes its forces, energies, losses, area, depth and stiffness. Returns
/// the normal force [N].
template <class Law, bool friction, class Contacts>
double respond(const PairMaterial& material, const BallContactOf<double>& contact, const Vec3& n,
               const ContactSlip& slip, Contacts& k, int i) {
  const RoundAnswer<Vec3> r =
      round_answer<Law, friction>(ball_material(material), contact, n, slip, k.viscous[i],
                                  k.friction[i], k.friction_stiffness[i]);
  k.touching[i] = 1;
  k.force[i] = r.force;
  k.normal_force[i] = r.normal;
  k.viscous_loss[i] = r.viscous_loss;
  k.friction_energy[i] = r.slide.stored;
  k.friction_loss[i] = r.slide.dissipated;
  k.energy[i] = r.law.energy;
  k.area[i] = M_PI * contact.radius * contact.overlap;
  k.depth[i] = contact.overlap;
  k.stiffness[i] = r.law.stiffness;
  return r.law.force;
}

}  // namespace trackbed::dem
