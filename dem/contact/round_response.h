// What a round contact answers with, between two grains (Pairs) and between a grain and a surface
// (PatchContacts) alike: their arrays have the same names.
#pragma once
#include <cmath>

#include "dem/contact/friction.h"
#include "dem/contact/laws/ball_law.h"

namespace trackbed::dem {

/// Law, damping and friction of contact i over the step: advances its history, writes its forces
/// (on a), energies, losses, area, depth and stiffness. n unit, from a to b. Returns the normal
/// force [N].
template <class Law, bool friction, class Contacts>
double respond(const PairMaterial& material, const BallContact& contact, const Vec3& n,
               const ContactSlip& slip, Contacts& k, int i) {
  const BallResponse response = Law()(contact, material);
  const Vec3 normal = -response.force * n;
  const double viscous = response.force - response.elastic;
  k.viscous_loss[i] = (k.viscous[i] + viscous) / 2 * n.dot(slip.displacement);
  k.viscous[i] = viscous;
  Vec3 force = normal;
  if constexpr (friction) {
    const FrictionResult result =
        advance_friction(material.friction, response.tangential, n, response.force, slip,
                         k.friction[i], k.friction_stiffness[i]);
    force += k.friction[i];
    k.friction_energy[i] = result.stored;
    k.friction_loss[i] = result.dissipated;
  } else {
    k.friction_energy[i] = k.friction_loss[i] = 0;  // others may add
  }
  k.touching[i] = 1;
  k.force[i] = force;
  k.normal_force[i] = normal;
  k.energy[i] = response.energy;
  k.area[i] = M_PI * contact.radius * contact.overlap;
  k.depth[i] = contact.overlap;
  k.stiffness[i] = response.stiffness;
  return response.force;
}

}  // namespace trackbed::dem
