// What only a scene with a test of grains can have wrong.
#pragma once
#include "apps/trackbed/parameter_values.h"
#include "apps/trackbed/scene.h"

namespace trackbed::apps {

/// Throws InputError naming file, key, what was given and what is allowed.
void check_grain_test(const Scene&, const ParameterValues&);

}  // namespace trackbed::apps
