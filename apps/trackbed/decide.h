// What a scene leaves open with `auto`, decided by a criterion.
#pragma once
#include "apps/trackbed/scene.h"

namespace trackbed::apps {

/// Puts the chosen model in the place of `auto` and says why in Scene::decisions; also where a
/// choice of the scene takes the sense from another.
/// Sleeper/Model: rigid where the sleeper is a short beam on its bed (fem/bending.h), the bed taken
/// as stiff as ballast is at most (200 MPa), which errs on the side of elastic.
void decide(Scene&);

/// Whether the laws of all contacts are gradients of stored energy, so that the ledger can close.
/// Under shao2017 (Eq. 17 as printed) a closed path of two polyhedra does work.
bool stores_energy(const Scene&);

}  // namespace trackbed::apps
