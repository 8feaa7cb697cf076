// What no single value can tell: that the values of a scene fit together.
#pragma once
#include "apps/trackbed/parameter_values.h"
#include "apps/trackbed/scene.h"

namespace trackbed::apps {

/// Throws InputError naming the key to change, where it was given, and what would do.
void check_scene(const Scene& scene, const ParameterValues& values);

}  // namespace trackbed::apps
