// The materials of a scene and the constants of each pair of them.
#pragma once
#include "apps/trackbed/scene.h"
#include "dem/contact/pair_forces.h"

namespace trackbed::apps {

enum Material { kGrain, kCoarseGrain, kWall, kMirror, kPlate, kSleeper, kSubgrade, kMaterials };

/// All contacts have the stage's contact modulus; friction is that of what a grain touches, grain,
/// wall (tamping plates too), sleeper or subgrade, by its key. A mirror wall (symmetry) has none;
/// coarse grains (Zones) are the same rock. Contact/Pairs then changes single pairs; a modulus
/// given there holds for the loading stage and softens with the stage as the others do. Throws
/// InputError naming what is wrong in Contact/Pairs.
dem::PairMaterials make_materials(const Scene&, double modulus, double grain_friction);

}  // namespace trackbed::apps
