// Energies of the bodies and their contacts, functions of the state alone [J]. With the work and
// losses that drift, kick and the pairs report they make a ledger that closes only if the forces
// are right:  kinetic + gravity + normal + tangential - (at start) = work - dissipated.
// Prescribed directions do not count: their energy belongs to who drives them.
#pragma once
#include "dem/contact/pairs.h"
#include "dem/motion/motion.h"

namespace trackbed::dem {

struct Energies {
  double kinetic = 0, gravity = 0;    ///< gravity: 0 at the origin of the scene
  double normal = 0, tangential = 0;  ///< stored in contacts
  double total() const { return kinetic + gravity + normal + tangential; }
};

/// Loads and losses since the start [J].
struct EnergyFlow {
  double applied = 0, prescribed = 0;      ///< work put in
  double friction = 0, local_damping = 0;  ///< dissipated
  double contact_damping = 0;              ///< dissipated
  double total() const { return applied + prescribed - friction - local_damping - contact_damping; }
};

double kinetic_energy(const Bodies&);
double gravity_energy(const Bodies&, const Vec3& gravity);
Energies energies(const Bodies&, const Pairs&, const Vec3& gravity);

/// Dissipated by friction in the last evaluation, summed in fixed order [J].
double friction_loss(const Pairs&, int threads);

/// The same by damping in contacts [J].
double viscous_loss(const Pairs&, int threads);

}  // namespace trackbed::dem
