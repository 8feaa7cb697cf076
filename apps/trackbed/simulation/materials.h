// The materials of a scene and the constants of each pair of them.
#pragma once
#include "apps/trackbed/scene.h"
#include "dem/contact/pair_forces.h"

namespace trackbed::apps {

enum Material { kGrain, kWall, kMirror, kPlate, kSleeper, kSubgrade, kMaterials };

/// All contacts have the stage's contact modulus; friction is that of the softer partner's key.
/// A mirror wall (symmetry) has none.
inline dem::PairMaterials make_materials(const Scene& s, double modulus, double grain_friction) {
  dem::PairMaterials table(kMaterials);
  const double friction[kMaterials] = {
      grain_friction,       s.container.friction, 0,
      s.container.friction, s.sleeper.friction,   s.subgrade.friction};
  for (int i = 0; i < kMaterials; ++i)
    for (int j = i; j < kMaterials; ++j)
      table.set(i, j, {modulus, i == kMirror ? 0 : friction[j], s.contact.tangential_ratio});
  return table;
}

}  // namespace trackbed::apps
