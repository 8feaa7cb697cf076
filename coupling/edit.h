// Changing which bodies a world holds, between stages: grains dropped in, plate off, sleeper in.
// Contact history of all pairs that remain, and of grains on surfaces, is kept. Call prepare()
// after.
#pragma once
#include <string>
#include <vector>

#include "coupling/world.h"

namespace trackbed::coupling {

/// Puts the bodies in a new order and drops those not in it: new body k is old body order[k];
/// `grains` of them are grains, which must come first.
void reorder(World&, const std::vector<int>& order, int grains);

/// Adds grains of the given shapes at rest; they follow the grains already there.
void add_grains(World&, const std::vector<dem::GrainShape>&, const std::vector<dem::Vec3>& centre,
                const std::vector<dem::Quat>& turn, double density, int material);

/// Removes the bodies whose index is in `bodies`.
void remove_bodies(World&, const std::vector<int>& bodies);

}  // namespace trackbed::coupling
