// That the structures of a scene can be built: found when the scene is read, not when the ballast
// has been packed.
#pragma once
#include "apps/trackbed/parameter_values.h"
#include "apps/trackbed/scene.h"

namespace trackbed::apps {

/// Builds the subgrade on a coarse mesh, so that its model judges its own parameters, and a sleeper
/// that comes from a file. Throws InputError naming the key to change and where it was given.
void check_structures(const Scene& scene, const ParameterValues& values);

}  // namespace trackbed::apps
