// Eight round contacts at a time, whatever their shapes: from where they touch to forces and
// history. Included by the loops over pairs, nowhere else.
#pragma once
#include <algorithm>

#include "dem/contact/eight_vectors.h"
#include "dem/contact/pair_forces.h"
#include "dem/contact/round_response.h"

namespace trackbed::dem {

/// Pairs to a stretch of a list of so many. Those that touch are taken in order, eight by eight,
/// within a stretch: which of them go together does not depend on the number of threads. Of a short
/// list there are some sixteen, enough for threads to have about the same to do.
inline int stretch_of(int pairs) { return std::clamp(pairs / 16 / 8 * 8, 32, 128); }

/// Where up to eight pairs touch; relative to their a's centre, world axes.
struct EightContacts {
  Eightfold pair, a, b;  ///< places in Pairs and Bodies
  Eight overlap;         ///< delta > 0 [m]
  Eight radius;          ///< R* [m]
  Eight3 n;              ///< unit, from a to b
  Eight3 arm_a;          ///< contact point less a's centre [m]
  Eight3 apart;          ///< b's centre less a's [m]
};

struct EightConstants {
  Eight mass;  ///< BallContactOf::mass [kg]; any where nothing is damped
  BallMaterialOf<Eight> material;
};

inline Eight contact_masses(const Bodies& b, const EightContacts& e) {
  unsigned held = 0;  // highest bit: some freedom is kFixed, zero
  for (int k = 0; k < 8; ++k) held |= (b.freedom[e.a.at[k]] - 1u) | (b.freedom[e.b.at[k]] - 1u);
  if (held >> 31) return eight_of([&](int k) { return contact_mass(b, e.a.at[k], e.b.at[k]); });
  const Eight of_a = read(b.mass.data(), e.a), of_b = read(b.mass.data(), e.b);
  return of_a * of_b / (of_a + of_b);
}

inline EightConstants constants_of(const Bodies& b, const PairMaterials& materials,
                                   const EightContacts& e) {
  EightConstants c;
  c.mass = materials.has_damping() ? contact_masses(b, e) : 1;
  const PairMaterial* of[8] = {&materials(b.material[e.a.at[0]], b.material[e.b.at[0]])};
  bool same = true;
  if (materials.materials() > 1)
    for (int k = 1; k < 8; ++k) {
      of[k] = &materials(b.material[e.a.at[k]], b.material[e.b.at[k]]);
      same = same && of[k] == of[0];
    }
  const auto eight = [&](double PairMaterial::*value) {
    return same ? Eight(of[0]->*value) : eight_of([&](int k) { return of[k]->*value; });
  };
  c.material = {eight(&PairMaterial::modulus), eight(&PairMaterial::friction),
                eight(&PairMaterial::damping), eight(&PairMaterial::stiffness),
                eight(&PairMaterial::round_ratio)};
  return c;
}

/// Law, damping and friction over the step: advances the pairs' history, writes their forces, arms,
/// energies, losses. Returns the normal forces [N].
template <class Law, bool friction>
Eight respond(const Bodies& b, const PairMaterials& materials, const StepContext& c,
              const EightContacts& e, Pairs& pairs) {
  const EightConstants constants = constants_of(b, materials, e);
  const Eight3 arm_b = e.arm_a - e.apart;
  SlipOf<Eight3> slip{Eight3(0, 0, 0), Eight3(0, 0, 0)};
  if (c.dt > 0) {
    const Eight old = read(pairs.touching.data(), e.pair), half = 0.5;
    const Eight3 old_a = where_less(half, old, read(pairs.arm_a.data(), e.pair), e.arm_a),
                 old_b = where_less(half, old, read(pairs.arm_b.data(), e.pair), arm_b);
    slip = contact_slip(c.dt, read(b.v.data(), e.a), read(b.turn.data(), e.a), old_a, e.arm_a,
                        read(b.v.data(), e.b), read(b.turn.data(), e.b), old_b, arm_b);
  }
  BallContactOf<Eight> contact;
  contact.overlap = e.overlap;
  contact.radius = e.radius;
  contact.rate = c.dt > 0 ? (1 / c.dt) * dot(e.n, slip.displacement) : 0;
  contact.mass = constants.mass;
  contact.dt = c.dt;
  Eight viscous = read(pairs.viscous.data(), e.pair);
  Eight3 tangential(0, 0, 0);
  Eight stiffness = 0;
  if constexpr (friction) {
    tangential = read(pairs.friction.data(), e.pair);
    stiffness = read(pairs.friction_stiffness.data(), e.pair);
  }
  const RoundAnswer<Eight3> r = round_answer<Law, friction>(constants.material, contact, e.n, slip,
                                                            viscous, tangential, stiffness);
  if constexpr (friction) {
    write(pairs.friction.data(), e.pair, tangential);
    write(pairs.friction_stiffness.data(), e.pair, stiffness);
  }
  write(pairs.axis.data(), e.pair, e.n);
  write(pairs.arm_a.data(), e.pair, e.arm_a);
  write(pairs.arm_b.data(), e.pair, arm_b);
  write(pairs.viscous.data(), e.pair, viscous);
  write(pairs.viscous_loss.data(), e.pair, r.viscous_loss);
  write(pairs.force.data(), e.pair, r.force);
  write(pairs.normal_force.data(), e.pair, r.law.force);
  write(pairs.friction_energy.data(), e.pair, r.slide.stored);
  write(pairs.friction_loss.data(), e.pair, r.slide.dissipated);
  write(pairs.energy.data(), e.pair, r.law.energy);
  write(pairs.area.data(), e.pair, M_PI * e.radius * e.overlap);
  write(pairs.depth.data(), e.pair, e.overlap);
  write(pairs.stiffness.data(), e.pair, r.law.stiffness);
  for (int k = 0; k < e.pair.count; ++k) pairs.touching[e.pair.at[k]] = 1;
  if (pairs.resists)  // which adds to it
    for (int k = 0; k < e.pair.count; ++k) pairs.couple[e.pair.at[k]].setZero();
  return r.law.force;
}

}  // namespace trackbed::dem
